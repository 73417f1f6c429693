/// @file
/// Edges of the oracle's spinning body with their revolutions counted, as input of the estimator
/// `batch`.

#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <span>
#include <vector>

#include "pipelines/frames/celestial.h"
#include "pipelines/spin/batch/pass_model.h"
#include "tests/support/observed_spin.h"
#include "tests/support/spinning_body.h"

namespace spindrift::testing {

/// Returns the noisy edges of this many revolutions from `kTransferStart` on; the noise is the
/// mission's.
inline std::vector<Edge> edges_of_turns(const SpinningBody& body, const SunEarthEphemeris& around,
                                        double turns) {
  return edges_between(body, around, 0.0, turns * 2.0 * std::numbers::pi / body.rate_rad_s);
}

inline std::vector<PassEdge> counted(const SpinningBody& body, const std::vector<Pulse>& pulses) {
  std::vector<PassEdge> counted;
  for (const Pulse& pulse : pulses) {
    const double turns =
        seconds_between(kTransferStart, pulse.t) * body.rate_rad_s / (2.0 * std::numbers::pi);
    counted.push_back({.pulse = pulse, .revolution = static_cast<std::int64_t>(std::floor(turns))});
  }
  return counted;
}

inline std::vector<PassEdge> noisy_pass(const SpinningBody& body, const std::vector<Edge>& edges,
                                        std::mt19937_64& rng) {
  return counted(body, pulses_from(edges, kTransferStart, body.config.noise, rng));
}

/// Returns the true spin state in the body frame of the model, at the middle of the pass.
inline SpinState true_state(const SpinningBody& body, const PassModel& model) {
  const double turn_rad =
      body.first_turn_rad + body.rate_rad_s * seconds_between(kTransferStart, model.middle());
  return {.q_icrf_spin = frame_about(body.axis_icrf) *
                         Eigen::Quaterniond{Eigen::AngleAxisd{turn_rad, Eigen::Vector3d::UnitZ()}},
          .rate_rad_s = body.rate_rad_s,
          .drift_rad_s2 = 0.0};
}

/// Holds a random body that sees Sun and Earth from a transfer orbit.
struct BatchScene {
  std::mt19937_64 rng;
  Orbit orbit = transfer_orbit();
  SunEarthEphemeris around = seen_from(orbit, spherical_horizon_km(40.0));
  SpinningBody body = random_body(around, 3.0 * std::numbers::pi / 180.0, rng);

  explicit BatchScene(std::uint64_t seed) : rng{seed} {}

  std::vector<PassEdge> pass(double turns) { return pass_of(body, turns); }
  std::vector<PassEdge> pass_of(const SpinningBody& other, double turns) {
    return noisy_pass(other, edges_of_turns(other, around, turns), rng);
  }
  PassModel model(std::span<const PassEdge> edges) const {
    return PassModel::make(body.config, orbit, edges).value();
  }
};

/// Holds edges without noise and the spin state that they come from.
struct ExactPass {
  BatchScene scene{61};
  std::vector<PassEdge> edges = counted(
      scene.body, pulses_from(edges_of_turns(scene.body, scene.around, 60.0), kTransferStart));
  PassModel model = scene.model(edges);
  SpinState truth = true_state(scene.body, model);
};

/// Returns a start axis `off_rad` away from the true axis, like the result of a single fix.
inline Eigen::Vector3d start_near(const SpinningBody& body, double off_rad, std::mt19937_64& rng) {
  const double azimuth_rad = std::uniform_real_distribution{0.0, 2.0 * std::numbers::pi}(rng);
  return Eigen::AngleAxisd{azimuth_rad, body.axis_icrf} *
         (Eigen::AngleAxisd{off_rad, body.axis_icrf.unitOrthogonal()} * body.axis_icrf);
}

}  // namespace spindrift::testing
