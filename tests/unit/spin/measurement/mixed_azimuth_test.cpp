#include "pipelines/spin/measurement/mixed_azimuth.h"

#include <cmath>
#include <numbers>
#include <random>

#include "pipelines/frames/angle.h"
#include "tests/support/matchers.h"

namespace spindrift::mixed_azimuth_test {

constexpr double kPi = std::numbers::pi;
const SunSensor kSensor{.slit_cant_rad = 40.0 * kRadPerDeg,
                        .slit_separation_rad = 35.0 * kRadPerDeg};

/// Returns the cosine of the angle between Sun and Earth from the triangle with the axis.
double cos_sun_earth(double sun_rad, double earth_rad, double dihedral_rad) {
  return std::cos(sun_rad) * std::cos(earth_rad) +
         std::sin(sun_rad) * std::sin(earth_rad) * std::cos(dihedral_rad);
}

/// Returns the sun angle of a lag by the handbook's cot(theta_s) = sin(lag) / tan I.
double sun_angle_at(double lag_rad) {
  return std::atan2(std::tan(kSensor.slit_cant_rad), std::sin(lag_rad));
}

MixedAzimuth mixed_at(double lag_rad, double dihedral_rad, double earth_rad) {
  return {
      .sensor = kSensor,
      .azimuth_rad = dihedral_rad - kSensor.slit_separation_rad - lag_rad,
      .earth_angle_rad = earth_rad,
      .sun_earth_rad = std::acos(cos_sun_earth(sun_angle_at(lag_rad), earth_rad, dihedral_rad))};
}

TEST(MixedAzimuth, EveryRootSatisfiesTheTriangleAndOneIsTheTruth) {
  std::mt19937_64 rng{51};
  std::uniform_real_distribution<double> uniform{-1.0, 1.0};
  int missed = 0;
  constexpr int kTrials = 2000;
  for (int trial = 0; trial < kTrials; ++trial) {
    SCOPED_TRACE(trial);
    const double lag_rad = 1.5 * uniform(rng);
    const MixedAzimuth mixed =
        mixed_at(lag_rad, kPi * uniform(rng), (90.0 + 20.0 * uniform(rng)) * kRadPerDeg);
    const SlitLags found = slit_lags(mixed);
    bool true_one = false;
    for (const SlitLag& lag : found.lags) {
      ASSERT_NEAR(cos_sun_earth(sun_angle_at(lag.lag_rad), mixed.earth_angle_rad,
                                mixed.azimuth_rad + kSensor.slit_separation_rad + lag.lag_rad),
                  std::cos(mixed.sun_earth_rad), 1e-13);
      true_one = true_one || std::abs(lag.lag_rad - lag_rad) < 1e-6;
    }
    if (!true_one) {
      ++missed;
      // The roots are less than a degree apart, and the miss between them follows a parabola.
      ASSERT_LT(found.nearest_miss, 1e-3);
    }
  }
  EXPECT_LT(missed, kTrials / 50);
}

TEST(MixedAzimuth, DerivativesAreThoseOfTheRoot) {
  const MixedAzimuth mixed = mixed_at(0.4, 1.3, 1.6);
  constexpr double kStep_rad = 1e-5;
  const auto root_near = [&](const MixedAzimuth& moved) {
    for (const SlitLag& lag : slit_lags(moved).lags) {
      if (std::abs(lag.lag_rad - 0.4) < 0.01) {
        return lag;
      }
    }
    ADD_FAILURE();
    return SlitLag{};
  };
  const auto moved = [&](double earth_rad, double azimuth_rad) {
    MixedAzimuth other = mixed;
    other.earth_angle_rad += earth_rad;
    other.azimuth_rad += azimuth_rad;
    return root_near(other).lag_rad;
  };
  const SlitLag root = root_near(mixed);
  EXPECT_NEAR(root.to_earth_angle,
              (moved(kStep_rad, 0.0) - moved(-kStep_rad, 0.0)) / (2.0 * kStep_rad), 1e-8);
  EXPECT_NEAR(root.to_azimuth, (moved(0.0, kStep_rad) - moved(0.0, -kStep_rad)) / (2.0 * kStep_rad),
              1e-8);
}

TEST(MixedAzimuth, IsPredictedAsItIsMeasured) {
  EXPECT_NEAR(predict_mixed_azimuth_rad(kSensor, sun_angle_at(0.3), 1.1).value(),
              1.1 - 35.0 * kRadPerDeg - 0.3, 1e-14);
  EXPECT_FALSE(predict_mixed_azimuth_rad(kSensor, 39.0 * kRadPerDeg, 1.1));
  EXPECT_FALSE(predict_mixed_azimuth_rad(kSensor, 141.0 * kRadPerDeg, 1.1));
}

}  // namespace spindrift::mixed_azimuth_test
