#include "pipelines/three_axis/attitude_estimator.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/rotation_vector.h"
#include "tests/support/turning_body.h"

namespace spindrift::attitude_estimator_test {

using Eigen::Vector3d;
using testing::at_s;
using testing::error_rad;
using testing::Sensors;
using testing::TurningBody;
using testing::usual_three_axis;

/// A pass of two minutes; the sensors that a test wants, when it wants them.
class AttitudeEstimatorTest : public ::testing::Test {
 protected:
  static constexpr double kLong_s = 120.0;

  void gyro(double t_s) { estimator_.push(sensors_.gyro(t_s), products_); }
  void star(double t_s) { estimator_.push(sensors_.star(t_s), products_); }
  void star(double t_s, const Vector3d& off_rad) {
    StarFix fix = sensors_.star(t_s);
    fix.q_icrf_sensor = quaternion_by(off_rad) * fix.q_icrf_sensor;
    estimator_.push(fix, products_);
  }
  void direction(double t_s, SampleKind kind, const Vector3d& ref_icrf, double sigma_rad) {
    estimator_.push(
        SeenDirection{.t = at_s(t_s),
                      .kind = kind,
                      .direction = {.body = sensors_.direction(t_s, ref_icrf, sigma_rad),
                                    .ref = ref_icrf,
                                    .sigma_rad = sigma_rad}},
        products_);
  }
  void sun(double t_s) {
    direction(t_s, SampleKind::Sun, sun_icrf_, config_.sun_sensor->noise_rad);
  }
  void field(double t_s) {
    direction(t_s, SampleKind::Magnetometer, field_icrf_, 0.5 * kRadPerDeg);
  }

  /// Gyro at 10 Hz from 0.1 s after `from_s` on, and whatever else at whole seconds behind it.
  void run(double from_s, double to_s, const std::function<void(double)>& at_second) {
    for (int i = static_cast<int>(std::lround(from_s * 10.0)) + 1; i <= std::lround(to_s * 10.0);
         ++i) {
      gyro(0.1 * i);
      if (i % 10 == 0) {
        at_second(0.1 * i);
      }
    }
  }

  std::vector<AttitudeEstimate> estimates() const {
    std::vector<AttitudeEstimate> out;
    for (const ThreeAxisProduct& product : products_) {
      if (const auto* estimate = std::get_if<AttitudeEstimate>(&product)) {
        out.push_back(*estimate);
      }
    }
    return out;
  }
  AttitudeEstimate last() const { return estimates().back(); }
  Quality quality() const { return last().assessment.quality; }
  double seconds_of(const AttitudeEstimate& estimate) const {
    return seconds_between(at_s(0.0), estimate.t);
  }
  double error_deg(const AttitudeEstimate& estimate) const {
    const double t_s = std::round(seconds_of(estimate) * 1e3) * 1e-3;
    return degrees(error_rad(estimate.q_icrf_body, body_.q_icrf_body(t_s)).norm());
  }
  const SensorHealth& health(SampleKind kind) const {
    return estimator_.sensors().at(index_of(kind));
  }

  std::mt19937_64 rng_{81};
  ThreeAxisConfig config_ = usual_three_axis();
  TurningBody body_ = TurningBody::smooth(rng_, kLong_s, 2.0 * kRadPerDeg);
  Sensors sensors_{body_, config_, rng_};
  Vector3d sun_icrf_ = Vector3d{0.3, -0.8, 0.5}.normalized();
  Vector3d field_icrf_ = Vector3d{0.9, 0.4, 0.1}.normalized();
  AttitudeEstimator estimator_{config_};
  AttitudeEstimator::Products products_;
};

TEST_F(AttitudeEstimatorTest, TwoDirectionsThatContradictEachOtherBeginNothing) {
  gyro(0.0);
  sun(0.0);
  // Twenty degrees nearer to the Sun than it is.
  const Vector3d nearer = (field_icrf_ + 0.35 * sun_icrf_).normalized();
  estimator_.push(SeenDirection{.t = at_s(0.0),
                                .kind = SampleKind::Magnetometer,
                                .direction = {.body = sensors_.direction(0.0, nearer, 0.0),
                                              .ref = field_icrf_,
                                              .sigma_rad = 0.5 * kRadPerDeg}},
                  products_);
  EXPECT_FALSE(estimator_.filter());
  run(0.0, 1.0, [&](double t_s) {
    sun(t_s);
    field(t_s);
  });
  estimator_.settle(products_);
  EXPECT_TRUE(estimator_.filter());
}

TEST_F(AttitudeEstimatorTest, BeforeTheFirstFixThereIsNothing) {
  run(0.0, 10.0, [&](double t_s) { sun(t_s); });
  estimator_.settle(products_);
  EXPECT_TRUE(products_.empty());
  EXPECT_FALSE(estimator_.ever_began());
  EXPECT_EQ(health(SampleKind::Sun).accepted, 10);
}

TEST_F(AttitudeEstimatorTest, TheFirstStarFixIsGivenAtOnce) {
  star(0.05);
  ASSERT_EQ(estimates().size(), 1U);
  EXPECT_EQ(quality(), Quality::Converging);
  EXPECT_EQ(last().t, at_s(0.05));
  EXPECT_FALSE(last().rate_body_rad_s);
  EXPECT_NEAR(last().sigma_rad(), std::sqrt(3.0) * config_.star_tracker->noise_rad, 1e-12);
  EXPECT_LT(error_deg(last()), 0.03);
}

TEST_F(AttitudeEstimatorTest, AFixBetweenGyroSamplesWaitsForTheSecond) {
  gyro(0.0);
  gyro(0.1);
  star(0.15);
  EXPECT_TRUE(estimates().empty());
  gyro(0.2);
  ASSERT_GE(estimates().size(), 1U);
  EXPECT_EQ(estimates().front().t, at_s(0.15));
  EXPECT_LT(error_deg(estimates().front()), 0.03);
}

TEST_F(AttitudeEstimatorTest, TwoDirectionsBegin) {
  gyro(0.0);
  gyro(0.1);
  sun(0.1);
  run(0.1, 2.0, [](double) {});
  EXPECT_TRUE(estimates().empty());
  field(2.0);
  ASSERT_EQ(estimates().size(), 1U);
  EXPECT_EQ(last().t, at_s(2.0));
  // Carried over 1.9 s in which the body has turned by degrees.
  EXPECT_LT(error_deg(last()), 3.0 * degrees(last().sigma_rad()));
  EXPECT_LT(degrees(last().sigma_rad()), 2.0);
}

TEST_F(AttitudeEstimatorTest, DirectionsTooFarApartInTimeDoNotBegin) {
  gyro(0.0);
  sun(0.0);
  run(0.0, 6.0, [](double) {});
  field(6.0);
  EXPECT_TRUE(estimates().empty());
}

TEST_F(AttitudeEstimatorTest, IsCheckedByTenStarFixes) {
  gyro(0.0);
  star(0.0);
  run(0.0, 9.0, [&](double t_s) { star(t_s); });
  EXPECT_EQ(quality(), Quality::Converging);
  run(9.0, 11.0, [&](double t_s) { star(t_s); });
  EXPECT_EQ(quality(), Quality::Ok);
  EXPECT_TRUE(last().assessment.reasons.empty());
  EXPECT_LT(error_deg(last()), 3.0 * degrees(last().sigma_rad()));
}

TEST_F(AttitudeEstimatorTest, TheSunAloneChecksNoTurnAboutIt) {
  gyro(0.0);
  star(0.0);
  run(0.0, 60.0, [&](double t_s) { sun(t_s); });
  EXPECT_EQ(quality(), Quality::Converging);
  run(60.0, 100.0, [&](double t_s) {
    sun(t_s);
    field(t_s);
  });
  EXPECT_EQ(quality(), Quality::Ok);
}

TEST_F(AttitudeEstimatorTest, GivesAtMostTenASecondAndTheRateLessTheBias) {
  star(0.0);
  for (int i = 0; i <= 1000; ++i) {
    gyro(0.02 * i);
    if (i % 50 == 0) {
      star(0.02 * i);
    }
  }
  EXPECT_NEAR(static_cast<double>(estimates().size()), 200.0, 2.0);
  const Vector3d true_rad_s = body_.rate_rad_s(std::round(seconds_of(last()) * 50.0) / 50.0);
  EXPECT_NEAR((*last().rate_body_rad_s - true_rad_s).norm(), 0.0, 5.0 * config_.gyro->noise_rad_s);
}

TEST_F(AttitudeEstimatorTest, AWrongFixIsRejectedWithItsInnovation) {
  gyro(0.0);
  star(0.0);
  run(0.0, 20.0, [&](double t_s) { star(t_s); });
  products_.clear();
  star(20.0, {0.01, 0.0, 0.0});
  ASSERT_EQ(products_.size(), 1U);
  const auto& rejected = std::get<RejectedSample>(products_.front());
  EXPECT_EQ(rejected.kind, SampleKind::Star);
  EXPECT_EQ(rejected.rejected_by, SampleRejection::Innovation);
  EXPECT_GT(*rejected.squared_innovation, innovation_gate(3));
  EXPECT_EQ(health(SampleKind::Star).rejected, 1);
  EXPECT_EQ(health(SampleKind::Star).rejected_in_a_row, 1);
  run(20.0, 30.0, [&](double t_s) { star(t_s); });
  EXPECT_EQ(health(SampleKind::Star).rejected_in_a_row, 0);
  EXPECT_EQ(quality(), Quality::Ok);
}

TEST_F(AttitudeEstimatorTest, FixesThatAgreeOverruleAFalseFirstOne) {
  gyro(0.0);
  star(0.0, {0.0, 0.5, 0.3});
  run(0.0, 1.0, [&](double t_s) { star(t_s); });
  run(1.0, 2.0, [&](double t_s) { star(t_s); });
  EXPECT_GT(error_deg(last()), 20.0);
  run(2.0, 14.0, [&](double t_s) { star(t_s); });
  EXPECT_LT(error_deg(last()), 0.03);
  EXPECT_EQ(quality(), Quality::Ok);
  ASSERT_TRUE(has(last().assessment, ReasonCode::Since));
  EXPECT_EQ(last().assessment.reasons.back().values.front().value,
            NamedValue::Value{tai_ns(at_s(3.0))});
}

TEST_F(AttitudeEstimatorTest, AStuckTrackerOverrulesNothing) {
  gyro(0.0);
  star(0.0);
  run(0.0, 20.0, [&](double t_s) {
    star(t_s);
    sun(t_s);
  });
  StarFix stuck = sensors_.star(20.0);
  run(20.0, 40.0, [&](double t_s) {
    stuck.t = at_s(t_s);
    estimator_.push(stuck, products_);
    sun(t_s);
    field(t_s);
  });
  EXPECT_LT(error_deg(last()), 1.0);
  EXPECT_EQ(quality(), Quality::Doubtful);
  EXPECT_TRUE(has(last().assessment, ReasonCode::SensorGated));
  EXPECT_FALSE(has(last().assessment, ReasonCode::Since));
}

TEST_F(AttitudeEstimatorTest, WhereAllIsRejectedItIsLostAndBeginsAtTheNextFix) {
  gyro(0.0);
  star(0.0);
  run(0.0, 20.0, [&](double t_s) { star(t_s); });
  // The Sun elsewhere, and no star.
  run(20.0, 30.5, [&](double t_s) {
    estimator_.push(
        SeenDirection{.t = at_s(t_s),
                      .kind = SampleKind::Sun,
                      .direction = {.body = body_.q_icrf_body(t_s).conjugate() * field_icrf_,
                                    .ref = sun_icrf_,
                                    .sigma_rad = 0.01}},
        products_);
  });
  const AttitudeEstimate lost = last();
  EXPECT_EQ(lost.assessment.quality, Quality::Lost);
  EXPECT_TRUE(has(lost.assessment, ReasonCode::AwaitingFix));
  EXPECT_GT(degrees(lost.sigma_rad()), 100.0);
  EXPECT_FALSE(estimator_.filter());
  run(30.5, 40.0, [](double) {});
  EXPECT_EQ(last().t, lost.t);
  star(40.0);
  EXPECT_EQ(quality(), Quality::Converging);
  EXPECT_TRUE(has(last().assessment, ReasonCode::Since));
  EXPECT_LT(error_deg(last()), 0.03);
}

TEST_F(AttitudeEstimatorTest, AGapOfTheGyroWidensAndTheNextFixHoldsIt) {
  gyro(0.0);
  star(0.0);
  run(0.0, 30.0, [&](double t_s) { star(t_s); });
  const double before_deg = degrees(last().sigma_rad());
  // Nothing for 12 s, then the gyro again.
  gyro(42.0);
  EXPECT_GT(degrees(last().sigma_rad()), 20.0 * before_deg);
  EXPECT_LT(error_deg(last()), 3.0 * degrees(last().sigma_rad()));
  EXPECT_TRUE(last().rate_body_rad_s);
  EXPECT_EQ(quality(), Quality::Doubtful);
  EXPECT_EQ(last().assessment.reasons.front(),
            (Reason{ReasonCode::GyroGaps, {{"count", std::int64_t{1}}, {"longest_s", 12.0}}}));
  run(42.0, 60.0, [&](double t_s) { star(t_s); });
  EXPECT_EQ(quality(), Quality::Ok);
  EXPECT_LT(degrees(last().sigma_rad()), 2.0 * before_deg);
  EXPECT_EQ(health(SampleKind::Star).rejected, 0);
}

TEST_F(AttitudeEstimatorTest, WithoutGyroTheLastRateIsHeldAndTheEstimateSaysSo) {
  gyro(0.0);
  star(0.0);
  run(0.0, 30.0, [&](double t_s) { star(t_s); });
  star(36.0);
  EXPECT_EQ(quality(), Quality::Doubtful);
  ASSERT_TRUE(has(last().assessment, ReasonCode::NoGyro));
  EXPECT_EQ(last().assessment.reasons.front(),
            (Reason{ReasonCode::NoGyro,
                    {{"why", std::string{"silent"}}, {"since_tai_ns", tai_ns(at_s(30.0))}}}));
  EXPECT_FALSE(last().rate_body_rad_s);
  EXPECT_LT(error_deg(last()), 0.03);
}

TEST_F(AttitudeEstimatorTest, AfterAFixInAGapTheRestOfItWidensToo) {
  gyro(0.0);
  star(0.0);
  run(0.0, 30.0, [&](double t_s) { star(t_s); });
  star(36.0);
  const double at_fix_deg = degrees(last().sigma_rad());
  gyro(40.0);
  EXPECT_EQ(last().t, at_s(40.0));
  EXPECT_GT(degrees(last().sigma_rad()), 50.0 * at_fix_deg);
  EXPECT_LT(error_deg(last()), 3.0 * degrees(last().sigma_rad()));
  run(40.0, 55.0, [&](double t_s) { star(t_s); });
  EXPECT_EQ(quality(), Quality::Ok);
  EXPECT_EQ(health(SampleKind::Star).rejected, 0);
}

/// The body turns by 30 deg meanwhile, and stands as before at either end.
TEST_F(AttitudeEstimatorTest, WhatTurnedUnseenInAGapIsDoubtfulUntilItIsChecked) {
  GyroSample still{.t = at_s(0.0), .rate_body_rad_s = Vector3d::Zero()};
  const auto rest = [&](double from_s, double to_s) {
    for (int i = static_cast<int>(std::lround(from_s * 10.0)); i < std::lround(to_s * 10.0); ++i) {
      still.t = at_s(0.1 * i);
      still.rate_body_rad_s = testing::normal_vector(rng_, config_.gyro->noise_rad_s);
      estimator_.push(still, products_);
      if (i % 10 == 0) {
        StarFix fix = sensors_.star(0.0);
        fix.t = still.t;
        estimator_.push(fix, products_);
      }
    }
  };
  rest(0.0, 30.0);
  EXPECT_EQ(quality(), Quality::Ok);
  still.t = at_s(90.0);
  estimator_.push(still, products_);
  still.t = at_s(90.1);
  still.rate_body_rad_s.x() += 1e-6;
  estimator_.push(still, products_);
  EXPECT_EQ(quality(), Quality::Doubtful);
  EXPECT_TRUE(has(last().assessment, ReasonCode::GyroGaps));
  EXPECT_GT(degrees(last().sigma_rad()), 0.8);
  rest(90.2, 98.0);
  EXPECT_EQ(quality(), Quality::Doubtful);
  rest(98.0, 105.0);
  EXPECT_EQ(quality(), Quality::Ok);
}

TEST_F(AttitudeEstimatorTest, ASigmaAboveTenDegreesIsDoubtful) {
  gyro(0.0);
  star(0.0);
  run(0.0, 30.0, [&](double t_s) { star(t_s); });
  GyroSample saturated{.t = at_s(31.0), .rate_body_rad_s = Vector3d::Constant(1.0)};
  for (int second = 31; second < 1500 && degrees(last().sigma_rad()) < 12.0; ++second) {
    saturated.t = at_s(second);
    estimator_.push(saturated, products_);
  }
  EXPECT_TRUE(has(last().assessment, ReasonCode::AttitudeOpen));
}

TEST_F(AttitudeEstimatorTest, ASpikeOfTheGyroIsLeftOut) {
  config_.gyro->range_rad_s.reset();
  for (const double size_rad_s : {0.1 * kRadPerDeg, 10.0 * kRadPerDeg, 17.0}) {
    SCOPED_TRACE(size_rad_s);
    AttitudeEstimator estimator{config_};
    AttitudeEstimator clean{config_};
    AttitudeEstimator::Products products;
    for (int i = 0; i <= 300; ++i) {
      GyroSample sample = sensors_.gyro(0.1 * i);
      clean.push(sample, products);
      if (i == 200) {
        products.clear();
        sample.rate_body_rad_s.y() += size_rad_s;
      }
      estimator.push(sample, products);
      if (i < 150 && i % 10 == 0) {
        const StarFix fix = sensors_.star(0.1 * i);
        clean.push(fix, products);
        estimator.push(fix, products);
      }
    }
    EXPECT_EQ(estimator.sensors().at(index_of(SampleKind::Gyro)).rejected, 1);
    EXPECT_LT(degrees(angle_between_rad(estimator.filter()->q_icrf_body(),
                                        clean.filter()->q_icrf_body())),
              0.01);
  }
}

/// One degree per second within a sample, then back, while star fixes go on.
TEST_F(AttitudeEstimatorTest, WhatThrustersDoIsNoSpike) {
  for (const int samples_on : {1, 2, 4}) {
    AttitudeEstimator estimator{config_};
    AttitudeEstimator::Products products;
    for (int i = 0; i <= 300; ++i) {
      GyroSample sample{.t = at_s(0.1 * i),
                        .rate_body_rad_s = testing::normal_vector(rng_, config_.gyro->noise_rad_s)};
      const double up = std::clamp((i - 100.0) / samples_on, 0.0, 1.0);
      const double down = std::clamp((i - 200.0) / samples_on, 0.0, 1.0);
      sample.rate_body_rad_s.z() += kRadPerDeg * (up - down);
      estimator.push(sample, products);
    }
    EXPECT_EQ(estimator.sensors().at(index_of(SampleKind::Gyro)).rejected, 0) << samples_on;
  }
}

TEST_F(AttitudeEstimatorTest, AFrozenGyroIsNoGyro) {
  gyro(0.0);
  star(0.0);
  run(0.0, 30.0, [&](double t_s) { star(t_s); });
  GyroSample frozen = sensors_.gyro(30.1);
  for (int i = 301; i <= 340; ++i) {
    frozen.t = at_s(0.1 * i);
    estimator_.push(frozen, products_);
  }
  EXPECT_EQ(quality(), Quality::Doubtful);
  EXPECT_EQ(std::get<std::string>(last().assessment.reasons.front().values.front().value),
            "frozen");
  EXPECT_EQ(health(SampleKind::Gyro).rejected, 36);
}

TEST_F(AttitudeEstimatorTest, WhatNothingHoldsIsLostInTheEnd) {
  gyro(0.0);
  star(0.0);
  run(0.0, 30.0, [&](double t_s) { star(t_s); });
  GyroSample saturated{.t = at_s(31.0), .rate_body_rad_s = Vector3d::Constant(1.0)};
  for (int second = 31; second < 1500 && quality() != Quality::Lost; ++second) {
    saturated.t = at_s(second);
    estimator_.push(saturated, products_);
  }
  EXPECT_EQ(quality(), Quality::Lost);
  EXPECT_TRUE(has(last().assessment, ReasonCode::NoGyro));
}

TEST_F(AttitudeEstimatorTest, NoiseBeyondTheStatedIsSaidAndInTheSigma) {
  gyro(0.0);
  star(0.0);
  ThreeAxisConfig noisy = config_;
  noisy.star_tracker->noise_rad *= 2.0;
  Sensors worse{body_, noisy, rng_};
  run(0.0, 100.0, [&](double t_s) { estimator_.push(worse.star(t_s), products_); });
  EXPECT_EQ(quality(), Quality::Doubtful);
  ASSERT_TRUE(has(last().assessment, ReasonCode::SensorNoise));
  const Reason noise = last().assessment.reasons.front();
  EXPECT_EQ(std::get<std::string>(noise.values[0].value), "star");
  EXPECT_NEAR(std::get<double>(noise.values[1].value), 1.8, 0.3);
}

}  // namespace spindrift::attitude_estimator_test
