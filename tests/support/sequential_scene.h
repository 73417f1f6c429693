/// @file
/// Runs the estimator `sequential` alone on revolutions of a body in the transfer orbit, with fixes
/// chosen by the test.

#pragma once

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <cstddef>
#include <functional>
#include <random>
#include <vector>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/spin/sequential/sequential.h"
#include "services/base/assessment_words.h"
#include "tests/support/observed_spin.h"
#include "tests/support/spinning_body.h"

namespace spindrift::testing {

inline constexpr double kFixSigma_rad = 0.5 * kRadPerDeg;
// Chi-square quantile for a probability of 1e-4 and two degrees of freedom.
inline constexpr double kOneInTenThousand = 18.42;

inline double error_deg(const SpinEstimate& estimate, const Eigen::Vector3d& true_icrf) {
  return angle_between_rad(estimate.axis_icrf, true_icrf) / kRadPerDeg;
}

inline double sigma_deg(const SpinEstimate& estimate) {
  return std::sqrt(estimate.covariance_rad2.trace()) / kRadPerDeg;
}

/// Returns the fixes that are complete before the revolution of that index is processed.
using Fixes = std::function<std::vector<SpinFix>(std::size_t index)>;

/// Returns all estimates; the text of each one's reasons must fit a field of 95 characters.
inline std::vector<SpinEstimate> estimates(const SpinConfig& config,
                                           const std::vector<ObservedRevolution>& seen,
                                           const Fixes& fixes) {
  SequentialEstimator estimator{config};
  std::vector<SpinEstimate> all;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const auto estimate = estimator.update(seen[i].revolution, seen[i].sky, fixes(i));
    if (estimate) {
      EXPECT_LE(sentence_of(estimate->assessment).size(), 95U) << sentence_of(estimate->assessment);
      EXPECT_EQ(estimate->estimator, SpinEstimator::Sequential);
      all.push_back(*estimate);
    }
  }
  return all;
}

inline Fixes at_first(const SpinFix& fix) {
  return [fix](std::size_t i) { return i == 0 ? std::vector{fix} : std::vector<SpinFix>{}; };
}

/// Holds a random body in the transfer orbit.
struct Scene : Surroundings {
  std::mt19937_64 rng{27};
  SpinningBody body = random_body(around, 4.0 * kRadPerDeg, rng);

  std::vector<ObservedRevolution> seen(double from_s, double to_s) {
    return observed(body.config, orbit, pulses(body, from_s, to_s, rng));
  }
  SpinFix fix() { return drawn_fix(body.axis_icrf, kFixSigma_rad, rng); }
  /// Returns a fix whose axis is turned about the direction of the Earth.
  SpinFix false_fix(double angle_deg) {
    SpinFix wrong = fix();
    wrong.axis_icrf = turned_about_earth(angle_deg);
    return wrong;
  }
  /// Returns the revolutions of sensors whose noise is so many times the stated one.
  std::vector<ObservedRevolution> seen_noisily(double times, double to_s) {
    const PulseNoise stated = body.config.noise;
    body.config.noise = {.sun_s = times * stated.sun_s, .infrared_s = times * stated.infrared_s};
    auto noisy = seen(0.0, to_s);
    body.config.noise = stated;
    return noisy;
  }

  Eigen::Vector3d turned_about(const Eigen::Vector3d& direction, double angle_deg) const {
    return Eigen::AngleAxisd{angle_deg * kRadPerDeg, direction.normalized()} * body.axis_icrf;
  }
  Eigen::Vector3d turned_about_earth(double angle_deg) const {
    return turned_about(around.earth_icrf_km(0.0), angle_deg);
  }
};

/// Runs each test on a scene of its own.
struct SequentialOnAScene : ::testing::Test {
  Scene scene;
};

/// Returns the revolutions without the sun edges, which leaves a cone of axes about the Earth.
inline std::vector<ObservedRevolution> without_sun(std::vector<ObservedRevolution> seen) {
  for (ObservedRevolution& observed : seen) {
    observed.revolution.edges.at(index_of(PulseChannel::Sun1)).reset();
    observed.revolution.edges.at(index_of(PulseChannel::Sun2)).reset();
  }
  return seen;
}

}  // namespace spindrift::testing
