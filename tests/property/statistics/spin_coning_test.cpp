#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/spin/sensor_model/coning.h"
#include "tests/support/normalised_square.h"
#include "tests/support/uniform_spin_residuals.h"

namespace spindrift::testing::spin_coning_test {

constexpr double kDuration_s = 300.0;
constexpr double kAligned_rad = 1e-7;
constexpr PulseNoise kNoise = {.sun_s = 1e-4, .infrared_s = 5e-4};
constexpr int kTrials = 60;
// The 99.9 % band of a mean of chi-squares with two degrees of freedom: 3.29 sqrt(4 / 60).
constexpr double kMeanOff = 0.85;

FittedConing fitted(const SpinTruth& truth, double alignment_sigma_rad, std::mt19937_64& rng) {
  return fitted_coning(turning(truth, kDuration_s), kNoise, alignment_sigma_rad, rng);
}

/// Returns the rotation that tilts the axis by this coning.
Eigen::Vector2d rotation_of(const Coning& coning) {
  return coning.tilt_rad *
         Eigen::Vector2d{std::sin(coning.azimuth_rad), std::cos(coning.azimuth_rad)};
}

double chi_square(const FittedConing& fit, const Eigen::Vector2d& coning_rad) {
  const Eigen::Vector2d off = fit.coning_rad - coning_rad;
  return normalised_square(off, fit.covariance_rad2);
}

ConingTest test_model_errors(const FittedConing& fit) {
  return test_coning(fit.coning_rad, fit.covariance_rad2);
}

TEST(SpinConing, OfAlignedSensorsIsFoundWhereItLeans) {
  std::mt19937_64 rng{1};
  double sum = 0.0;
  for (int i = 0; i < kTrials; ++i) {
    SpinTruth truth = steady_truth();
    const Coning coning = {.tilt_rad = 0.5 * kRadPerDeg, .azimuth_rad = 0.1 * i};
    truth.motion.coning = coning;
    const FittedConing fit = fitted(truth, kAligned_rad, rng);
    sum += chi_square(fit, rotation_of(coning));
    const ConingTest verdict = test_model_errors(fit);
    EXPECT_TRUE(verdict.detected);
    EXPECT_NEAR(verdict.tilt_rad, coning.tilt_rad, 0.25 * kRadPerDeg);
    EXPECT_NEAR(wrapped_rad(verdict.azimuth_rad - coning.azimuth_rad), 0.0, 0.5);
  }
  EXPECT_NEAR(sum / kTrials, 2.0, kMeanOff);
}

TEST(SpinConing, IsNotFoundWhereSensorsAreMisplacedAsMuchAsTheyMayBe) {
  std::mt19937_64 rng{2};
  constexpr double kMisplaced_rad = 0.1 * kRadPerDeg;
  std::normal_distribution<double> misplaced{0.0, kMisplaced_rad};
  double sum = 0.0;
  for (int i = 0; i < kTrials; ++i) {
    SpinTruth truth = steady_truth();
    truth.north->mount_angle_rad += misplaced(rng);
    truth.south->mount_angle_rad += misplaced(rng);
    truth.north->azimuth_rad += misplaced(rng);
    truth.south->azimuth_rad += misplaced(rng);
    truth.sun_sensor.slit_separation_rad += misplaced(rng);
    const FittedConing fit = fitted(truth, kMisplaced_rad, rng);
    sum += chi_square(fit, Eigen::Vector2d::Zero());
    const ConingTest verdict = test_model_errors(fit);
    EXPECT_FALSE(verdict.detected);
    // With aligned sensors it would be 0.4 deg.
    EXPECT_GT(verdict.detectable_rad, 2.0 * kRadPerDeg);
  }
  // Mounting angles have less effect here than the limb, which the fit allows for, so the mean is
  // at most 2.
  EXPECT_LT(sum / kTrials, 2.0 + kMeanOff);
  EXPECT_GT(sum / kTrials, 0.5);
}

TEST(SpinConing, BelowWhatCouldBeDetectedIsSaidToBe) {
  std::mt19937_64 rng{3};
  SpinTruth truth = steady_truth();
  truth.motion.coning = {.tilt_rad = 0.02 * kRadPerDeg, .azimuth_rad = 0.5};
  const ConingTest verdict = test_model_errors(fitted(truth, kAligned_rad, rng));
  EXPECT_FALSE(verdict.detected);
  EXPECT_GT(verdict.detectable_rad, 0.1 * kRadPerDeg);
  EXPECT_LT(verdict.detectable_rad, 0.5 * kRadPerDeg);
}

}  // namespace spindrift::testing::spin_coning_test
