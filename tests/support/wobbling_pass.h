/// @file
/// Passes of a nutating and coning body from the ground model, as input of the estimator `batch`.

#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "pipelines/frames/celestial.h"
#include "pipelines/ground_model/sensors/spin_edges.h"
#include "pipelines/spin/batch/batch_estimator.h"
#include "tests/support/spin_truth.h"

namespace spindrift::testing {

/// Returns edges with the mission's noise and their revolutions counted.
inline std::vector<PassEdge> edges_of(const SpinTruth& truth, const Orbit& orbit, double duration_s,
                                      const PulseNoise& noise, std::mt19937_64& rng) {
  std::normal_distribution<double> normal;
  std::vector<PassEdge> edges;
  SpinEdges true_edges{truth, orbit};
  const auto all = true_edges.until(duration_s).value();
  for (const TrueEdge& edge : all) {
    const double late_s = edge_sigma_s(noise, edge.channel) * normal(rng);
    const double turns = truth.motion.azimuth_rad(edge.t_s) / (2.0 * std::numbers::pi);
    edges.push_back(
        {.pulse = {.t = shifted(truth.start, edge.t_s + late_s), .channel = edge.channel},
         .revolution = static_cast<std::int64_t>(std::floor(turns))});
  }
  std::sort(edges.begin(), edges.end(),
            [](const PassEdge& one, const PassEdge& other) { return one.pulse < other.pulse; });
  return edges;
}

/// Draws passes in which chord, dihedral and sun angle are well observed.
class WobblingPasses {
 public:
  WobblingPasses(std::uint64_t seed, double duration_s) : duration_s_{duration_s}, rng_{seed} {}

  /// Returns the next random geometry and phase, with perfect sensors and a steady spin.
  SpinTruth drawn() {
    body_ = random_body(around_, 6.0 * std::numbers::pi / 180.0, rng_);
    return truth_of(body_);
  }
  double uniform() { return std::uniform_real_distribution{}(rng_); }

  /// Returns a nutation with random phase of a prolate or oblate body whose nutation frequency
  /// differs by at least 0.03 from one that is unobservable.
  Nutation random_nutation(double half_angle_rad) {
    double inertia_ratio = 1.0;
    while (std::abs(inertia_ratio - 1.0) < 0.03) {
      inertia_ratio = 0.03 + 1.94 * uniform();
    }
    return {.half_angle_rad = half_angle_rad,
            .inertia_ratio = inertia_ratio,
            .first_azimuth_rad = 2.0 * std::numbers::pi * uniform()};
  }

  std::vector<PassEdge> edges(const SpinTruth& truth) {
    return edges_of(truth, orbit_, duration_s_, body_.config.noise, rng_);
  }
  std::vector<Pulse> pulses(const SpinTruth& truth) {
    std::vector<Pulse> pulses;
    for (const PassEdge& edge : edges(truth)) {
      pulses.push_back(edge.pulse);
    }
    return pulses;
  }
  Expected<BatchSolution> solved(const std::vector<PassEdge>& edges) {
    const double azimuth_rad = 2.0 * std::numbers::pi * uniform();
    const Eigen::Vector3d start =
        Eigen::AngleAxisd{azimuth_rad, body_.axis_icrf} *
        (Eigen::AngleAxisd{0.01, body_.axis_icrf.unitOrthogonal()} * body_.axis_icrf);
    return solve_batch(body_.config, orbit_, edges, {{start}});
  }
  /// Returns the solution, which has to exist.
  BatchSolution solution(const std::vector<PassEdge>& edges) {
    const auto solution = solved(edges);
    EXPECT_TRUE(solution) << solution.error().message;
    return solution.value();
  }
  BatchSolution solution(const SpinTruth& truth) { return solution(edges(truth)); }
  SpinConfig& config() { return body_.config; }
  const Orbit& orbit() const { return orbit_; }

 private:
  double duration_s_;
  std::mt19937_64 rng_;
  Orbit orbit_ = transfer_orbit();
  SunEarthEphemeris around_ = seen_from(orbit_);
  SpinningBody body_ = body_across_the_earth();
};

/// Holds the error of a solution's axis.
struct AxisError {
  double squares;  ///< Normalised squared error: chi-square, two degrees of freedom.
  double rad2;
};
inline AxisError axis_error(const BatchSolution& solution, const SpinTruth& truth) {
  const Eigen::Vector3d& true_icrf = truth.motion.axis_icrf;
  return {.squares = squared_error(solution.estimate, true_icrf),
          .rad2 = error_rad(solution.estimate.axis_icrf, true_icrf).squaredNorm()};
}

// The 99.9 % point of chi-square with two degrees of freedom.
inline constexpr double kOneInAThousand = 13.8;

/// Returns the edges of one motion before `at` and those of another from then on.
inline std::vector<PassEdge> joined(std::vector<PassEdge> before, std::vector<PassEdge> after,
                                    TaiTime at) {
  std::erase_if(before, [&](const PassEdge& edge) { return edge.pulse.t >= at; });
  std::erase_if(after, [&](const PassEdge& edge) { return edge.pulse.t < at; });
  before.insert(before.end(), after.begin(), after.end());
  return before;
}

}  // namespace spindrift::testing
