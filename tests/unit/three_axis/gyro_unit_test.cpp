#include "pipelines/three_axis/gyro_unit.h"

#include <numbers>
#include <random>

#include "tests/support/matchers.h"
#include "tests/support/turning_body.h"

namespace spindrift::testing::gyro_unit_test {

using Eigen::Vector3d;

ObservedAttitude observed(const StarFix& fix, const StarTracker& tracker) {
  return {.q_icrf_body = fix.q_icrf_sensor * tracker.q_body_sensor.conjugate(),
          .sigma_rad = tracker.noise_rad};
}

/// Runs a gyro at 4 Hz with a star fix each second.
/// @return Unit factor found at the end.
std::optional<double> found(const TurningBody& body, std::mt19937_64& rng, double times,
                            int seconds) {
  const ThreeAxisConfig config = usual_three_axis();
  Sensors sensors{body, config, rng};
  GyroUnit unit{config.gyro->bias_sigma_rad_s};
  for (int i = 0; i < 4 * seconds; ++i) {
    GyroSample sample = sensors.gyro(0.25 * i);
    sample.rate_body_rad_s *= times;
    unit.observe(sample);
    if (i % 4 == 1) {
      unit.observe(at_s(0.25 * i + 0.1),
                   observed(sensors.star(0.25 * i + 0.1), *config.star_tracker));
    }
  }
  return unit.factor();
}

TEST(GyroUnit, DegreesAreFoundAtAnyRateAndRadiansAreNot) {
  std::mt19937_64 rng{45};
  for (const double rate_rad_s : {0.004, 0.02, 0.2}) {
    for (int trial = 0; trial < 10; ++trial) {
      SCOPED_TRACE(rate_rad_s);
      const TurningBody body = TurningBody::smooth(rng, 100.0, rate_rad_s);
      ASSERT_EQ(found(body, rng, kDegPerRad, 100), kDegPerRad);
      ASSERT_EQ(found(body, rng, 1.0, 100), std::nullopt);
      ASSERT_EQ(found(body, rng, 3.0, 100), std::nullopt);
    }
  }
}

TEST(GyroUnit, RadiansMadeTwiceAreFoundWhereTheBiasIsSmallBesideTheRate) {
  std::mt19937_64 rng{46};
  const TurningBody body{Eigen::Quaterniond::Identity(), 60.0, [](double) {
                           return Vector3d{0.1, 0.2, -0.1};
                         }};
  ASSERT_EQ(found(body, rng, kRadPerDeg, 60), kRadPerDeg);
}

/// Between two fixes the body rotates by 1/57 of the length of the gyro's path.
TEST(GyroUnit, OfABodyThatTurnsOnceBetweenTwoFixesIsRight) {
  std::mt19937_64 rng{47};
  const double rate_rad_s = 2.0 * std::numbers::pi * (1.0 + 1.0 / kDegPerRad);
  const TurningBody body{Eigen::Quaterniond::Identity(), 60.0, [rate_rad_s](double) {
                           return Vector3d{0.0, 0.0, rate_rad_s};
                         }};
  ASSERT_EQ(found(body, rng, 1.0, 60), std::nullopt);
}

TEST(GyroUnit, ThatIsSetRightIsBelievedAgain) {
  std::mt19937_64 rng{48};
  const ThreeAxisConfig config = usual_three_axis();
  const TurningBody body = TurningBody::smooth(rng, 200.0, 0.02);
  Sensors sensors{body, config, rng};
  GyroUnit unit{config.gyro->bias_sigma_rad_s};
  for (int i = 0; i < 800; ++i) {
    GyroSample sample = sensors.gyro(0.25 * i);
    sample.rate_body_rad_s *= i < 400 ? kDegPerRad : 1.0;
    unit.observe(sample);
    if (i % 4 == 0) {
      unit.observe(sample.t, observed(sensors.star(0.25 * i), *config.star_tracker));
    }
    if (i == 399) {
      EXPECT_EQ(unit.factor(), kDegPerRad);
    }
  }
  EXPECT_EQ(unit.factor(), std::nullopt);
}

}  // namespace spindrift::testing::gyro_unit_test
