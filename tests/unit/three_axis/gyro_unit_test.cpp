#include "pipelines/three_axis/gyro_unit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "pipelines/three_axis/attitude_estimator.h"
#include "tests/support/of_kind.h"
#include "tests/support/turning_body.h"

namespace spindrift::gyro_unit_test {

using Eigen::Vector3d;
using testing::at_s;
using testing::Sensors;
using testing::TurningBody;
using testing::usual_three_axis;

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

class GyroInDegrees : public ::testing::Test {
 protected:
  void push_all(ThreeAxisConfig config, double times) {
    Sensors sensors{body_, config, rng_};
    AttitudeEstimator estimator{config};
    for (int i = 0; i < 480; ++i) {
      GyroSample sample = sensors.gyro(0.25 * i);
      sample.rate_body_rad_s *= times;
      estimator.push(sample, products_);
      if (i % 4 == 0) {
        estimator.push(sensors.star(0.25 * i), products_);
      }
    }
    estimator.settle(products_);
  }
  std::vector<AttitudeEstimate> estimates() const { return of_kind<AttitudeEstimate>(products_); }

  std::mt19937_64 rng_{49};
  TurningBody body_ = TurningBody::smooth(rng_, 120.0, 0.02);
  std::vector<ThreeAxisProduct> products_;
};

TEST_F(GyroInDegrees, IsNamedAndTheStarFixesAreTheAttitude) {
  push_all(usual_three_axis(), kDegPerRad);
  std::size_t lost = 0;
  for (const AttitudeEstimate& estimate : estimates()) {
    ASSERT_NE(estimate.assessment.quality, Quality::Ok);
    lost += estimate.assessment.quality == Quality::Lost ? 1 : 0;
  }
  EXPECT_LE(lost, 3U);
  const AttitudeEstimate last = estimates().back();
  EXPECT_EQ(last.assessment.quality, Quality::Doubtful);
  EXPECT_EQ(last.assessment.reasons.front(),
            (Reason{ReasonCode::GyroUnit, {{"factor", kDegPerRad}}}));
  // Three axes of 20 arcsec exceed five sigma once in 100,000 times.
  EXPECT_LT(testing::error_rad(last.q_icrf_body, body_.q_icrf_body(119.0)).norm(),
            5.0 * std::sqrt(3.0) * usual_three_axis().star_tracker->noise_rad);
}

TEST_F(GyroInDegrees, BeyondItsRangeIsNoGyro) {
  ThreeAxisConfig config = usual_three_axis();
  config.gyro->range_rad_s = 1e-4;
  push_all(config, 1.0);
  ASSERT_FALSE(estimates().empty());
  for (const AttitudeEstimate& estimate : estimates()) {
    ASSERT_EQ(estimate.assessment.quality, Quality::Doubtful);
    ASSERT_EQ(estimate.assessment.reasons.front(),
              (Reason{ReasonCode::NoGyro,
                      {{"why", "saturated"}, {"since_tai_ns", testing::kStart_tai_ns}}}));
  }
}

/// A step of the rate makes a sample wait for the next one, with two measurements at its time.
TEST(AttitudeAtTheInstantOfAGyroSample, IsFinite) {
  std::mt19937_64 rng{50};
  const ThreeAxisConfig config = usual_three_axis();
  const TurningBody body{Eigen::Quaterniond::Identity(), 10.0, [](double t_s) {
                           return Vector3d{t_s < 4.99 ? 0.0 : 0.1, 0.0, 0.0};
                         }};
  Sensors sensors{body, config, rng};
  AttitudeEstimator estimator{config};
  std::vector<ThreeAxisProduct> products;
  for (int i = 0; i < 40; ++i) {
    estimator.push(sensors.gyro(0.25 * i), products);
    if (i == 20) {
      estimator.push(
          SeenDirection{.t = at_s(5.0),
                        .kind = SampleKind::Sun,
                        .direction = {.body = sensors.direction(5.0, Vector3d::UnitZ(), 0.01),
                                      .ref = Vector3d::UnitZ(),
                                      .sigma_rad = 0.01}},
          products);
      estimator.push(sensors.star(5.0), products);
    }
  }
  const auto estimates = of_kind<AttitudeEstimate>(products);
  for (const AttitudeEstimate& estimate : estimates) {
    ASSERT_TRUE(estimate.rate_body_rad_s.value().allFinite());
  }
  EXPECT_GT(estimates.size(), 10U);
}

}  // namespace spindrift::gyro_unit_test
