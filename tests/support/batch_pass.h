/// @file
/// Edges of the oracle's spinning body with their revolutions counted, as input of the estimator
/// `batch`.

#pragma once

#include <gtest/gtest.h>

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
  return edges_between(body, around, 0.0, body.seconds_of(turns));
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
  return counted(body, noisy_pulses(body, edges, rng));
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

/// Steps an unknown of the motion, a bias or, after these, an unknown of the nutation.
inline SpinState stepped(const PassModel& model, SpinState state, int unknown, double step) {
  if (unknown < 3) {
    const Eigen::AngleAxisd turn{step, Eigen::Vector3d::Unit(unknown)};
    state.q_icrf_spin = state.q_icrf_spin * turn;
  } else if (unknown == 3) {
    state.rate_rad_s += step / model.half_s();
  } else if (unknown == 4) {
    state.drift_rad_s2 += 2.0 * step / (model.half_s() * model.half_s());
  } else if (unknown < kBatchUnknowns) {
    state.biases[unknown - kMotionUnknowns] += step;
  } else {
    state.nutation.front().unknowns[unknown - kBatchUnknowns] += step;
  }
  return state;
}

/// Expects the slopes of an edge's residual to be those of small steps of the first `unknowns`.
inline void expect_slopes(const PassModel& model, const SpinState& state, const Pulse& edge,
                          int unknowns, double relative_tolerance) {
  const auto here = model.at(state).residual(edge);
  ASSERT_TRUE(here);
  for (int i = 0; i < unknowns; ++i) {
    const double step = i == kMotionUnknowns + Co2HeightBias ? 1e-3 : 1e-6;
    const auto after = model.at(stepped(model, state, i, step)).residual(edge);
    const auto before = model.at(stepped(model, state, i, -step)).residual(edge);
    ASSERT_TRUE(after && before);
    const double given =
        i < kBatchUnknowns ? here->slopes[i] : here->nutation_slopes[i - kBatchUnknowns];
    EXPECT_NEAR(given, (after->off - before->off) / (2.0 * step),
                relative_tolerance * here->slopes.head<3>().norm())
        << name_of(edge.channel) << ", unknown " << i;
  }
}

/// Holds a random body that sees Sun and Earth from a transfer orbit.
struct BatchScene : Surroundings {
  std::mt19937_64 rng;
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
