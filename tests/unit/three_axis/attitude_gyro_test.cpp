/// What the estimator does without a gyro, and with one that has gaps and faults.

#include "tests/unit/three_axis/estimated_attitude.h"

namespace spindrift::testing::attitude_gyro_test {

class AttitudeGyroTest : public EstimatedAttitude {
 protected:
  /// Gives two minutes of a gyro at 4 Hz, with its rates times a factor, and of star fixes.
  void run_with_rates_times(double factor) {
    for (int i = 0; i < 480; ++i) {
      GyroSample sample = sensors_.gyro(0.25 * i);
      sample.rate_body_rad_s *= factor;
      push(sample);
      if (i % 4 == 0) {
        star(0.25 * i);
      }
    }
    estimator_.settle(products_);
  }
};

TEST_F(AttitudeGyroTest, WithoutAGyroSunAndFieldOfWithinASecondGiveAnAttitude) {
  const auto estimates_of_two = [&](double apart_s) {
    estimator_ = AttitudeEstimator{config_};
    products_.clear();
    sun(20.0);
    field(20.0 + apart_s);
    return estimates().size();
  };
  for (const double apart_s : {0.0, 0.01, 0.5, 1.0}) {
    SCOPED_TRACE(apart_s);
    ASSERT_EQ(estimates_of_two(apart_s), 1U);
    EXPECT_EQ(last().t, at_s(20.0 + apart_s));
    EXPECT_FALSE(last().rate_body_rad_s);
    EXPECT_EQ(quality(), Quality::Converging);
    // Two directions of 0.5 deg nearly perpendicular to each other, the first moved by 5 deg/s
    // about each axis.
    const double sun_deg = std::hypot(0.5, 5.0 * apart_s);
    const double along_both_deg = 1.0 / std::hypot(1.0 / sun_deg, 1.0 / 0.5);
    EXPECT_NEAR(sigma_deg(), std::hypot(0.5, sun_deg, along_both_deg), 0.05 * sun_deg);
    EXPECT_LT(error_deg(), 4.0 * sigma_deg());
  }
  EXPECT_EQ(estimates_of_two(1.005), 0U);
}

TEST_F(AttitudeGyroTest, ThatNeverCameIsWhyNothingChecksAnAttitude) {
  const auto reasons_by = [&] {
    estimator_ = AttitudeEstimator{config_};
    products_.clear();
    for (int second = 0; second < 30; ++second) {
      star(second);
    }
    EXPECT_EQ(quality(), Quality::Converging);
    return last().assessment.reasons;
  };
  const auto reason = [](const char* why) {
    return Reason{ReasonCode::NoGyro, {{"why", why}, {"since_tai_ns", tai_ns(at_s(0.0))}}};
  };
  EXPECT_THAT(reasons_by(), ElementsAre(reason("silent")));
  config_.gyro.reset();
  EXPECT_THAT(reasons_by(), ElementsAre(reason("undeclared")));
}

TEST_F(AttitudeGyroTest, WithoutAGyroEachPairOfDirectionsIsAnAttitudeAndAStarFixABetterOne) {
  for (int second = 0; second < 60; ++second) {
    sun(second);
    field(second + 0.05);
  }
  EXPECT_EQ(estimates().size(), 60U);
  EXPECT_EQ(quality(), Quality::Converging);
  products_.clear();
  for (int second = 60; second < 70; ++second) {
    star(second);
    sun(second + 0.05);
    field(second + 0.1);
  }
  EXPECT_EQ(estimates().size(), 10U);
  EXPECT_LT(sigma_deg(), 0.02);
}

TEST_F(AttitudeGyroTest, AGapOfTheGyroWidensAndTheNextFixHoldsIt) {
  track_stars(30.0);
  const double before_deg = sigma_deg();
  // The gyro is silent for 12 s.
  gyro(42.0);
  EXPECT_GT(sigma_deg(), 20.0 * before_deg);
  EXPECT_LT(error_deg(), 3.0 * sigma_deg());
  EXPECT_TRUE(last().rate_body_rad_s);
  EXPECT_EQ(quality(), Quality::Doubtful);
  EXPECT_EQ(last().assessment.reasons.front(),
            (Reason{ReasonCode::GyroGaps, {{"count", std::int64_t{1}}, {"longest_s", 12.0}}}));
  run(42.0, 60.0, {Star});
  EXPECT_EQ(quality(), Quality::Ok);
  EXPECT_LT(sigma_deg(), 2.0 * before_deg);
  EXPECT_EQ(health(Star).rejected, 0);
}

TEST_F(AttitudeGyroTest, AFixInAGapIsCarriedThereByTheLastRateAndTheRestOfTheGapWidensToo) {
  track_stars(30.0);
  star(36.0);
  EXPECT_EQ(quality(), Quality::Doubtful);
  EXPECT_EQ(
      last().assessment.reasons.front(),
      (Reason{ReasonCode::NoGyro, {{"why", "silent"}, {"since_tai_ns", tai_ns(at_s(30.0))}}}));
  EXPECT_FALSE(last().rate_body_rad_s);
  EXPECT_LT(error_deg(), 0.03);
  const double at_fix_deg = sigma_deg();
  gyro(40.0);
  EXPECT_EQ(last().t, at_s(40.0));
  EXPECT_GT(sigma_deg(), 50.0 * at_fix_deg);
  EXPECT_LT(error_deg(), 3.0 * sigma_deg());
  run(40.0, 55.0, {Star});
  EXPECT_EQ(quality(), Quality::Ok);
  EXPECT_EQ(health(Star).rejected, 0);
}

/// The body is at rest. The gyro is silent for a minute, in which the body could have turned
/// unseen.
TEST_F(AttitudeGyroTest, AMinuteWithoutGyroIsDoubtfulUntilStarFixesCheckIt) {
  const auto rest = [&](double from_s, double to_s) {
    for (int i = static_cast<int>(std::lround(from_s * 10.0)); i < std::lround(to_s * 10.0); ++i) {
      const Vector3d rate_rad_s = normal_vector(rng_, config_.gyro->noise_rad_s);
      push(GyroSample{.t = at_s(0.1 * i), .rate_body_rad_s = rate_rad_s});
      if (i % 10 == 0) {
        StarFix fix = sensors_.star(0.0);
        fix.t = at_s(0.1 * i);
        push(fix);
      }
    }
  };
  rest(0.0, 30.0);
  EXPECT_EQ(quality(), Quality::Ok);
  rest(90.1, 90.3);
  EXPECT_EQ(quality(), Quality::Doubtful);
  EXPECT_TRUE(says(ReasonCode::GyroGaps));
  EXPECT_GT(sigma_deg(), 0.8);
  rest(90.3, 98.0);
  EXPECT_EQ(quality(), Quality::Doubtful);
  rest(98.0, 105.0);
  EXPECT_EQ(quality(), Quality::Ok);
}

TEST_F(AttitudeGyroTest, ASpikeOfTheGyroIsLeftOut) {
  config_.gyro->range_rad_s.reset();
  for (const double size_rad_s : {0.1 * kRadPerDeg, 10.0 * kRadPerDeg, 17.0}) {
    SCOPED_TRACE(size_rad_s);
    AttitudeEstimator estimator{config_};
    AttitudeEstimator clean{config_};
    for (int i = 0; i <= 300; ++i) {
      GyroSample sample = sensors_.gyro(0.1 * i);
      clean.push(sample, products_);
      sample.rate_body_rad_s.y() += i == 200 ? size_rad_s : 0.0;
      estimator.push(sample, products_);
      if (i < 150 && i % 10 == 0) {
        const StarFix fix = sensors_.star(0.1 * i);
        clean.push(fix, products_);
        estimator.push(fix, products_);
      }
    }
    EXPECT_EQ(estimator.sensors().at(index_of(Gyro)).rejected, 1);
    EXPECT_LT(degrees(angle_between_rad(estimator.filter()->q_icrf_body(),
                                        clean.filter()->q_icrf_body())),
              0.01);
  }
}

/// The rate rises by 1 deg/s over one, two or four samples, and falls back ten seconds later.
TEST_F(AttitudeGyroTest, WhatThrustersDoIsNoSpike) {
  for (const int samples_on : {1, 2, 4}) {
    AttitudeEstimator estimator{config_};
    for (int i = 0; i <= 300; ++i) {
      GyroSample sample{.t = at_s(0.1 * i),
                        .rate_body_rad_s = normal_vector(rng_, config_.gyro->noise_rad_s)};
      const double up = std::clamp((i - 100.0) / samples_on, 0.0, 1.0);
      const double down = std::clamp((i - 200.0) / samples_on, 0.0, 1.0);
      sample.rate_body_rad_s.z() += kRadPerDeg * (up - down);
      estimator.push(sample, products_);
    }
    EXPECT_EQ(estimator.sensors().at(index_of(Gyro)).rejected, 0) << samples_on;
  }
}

TEST_F(AttitudeGyroTest, AFrozenGyroIsNoGyro) {
  track_stars(30.0);
  GyroSample frozen = sensors_.gyro(30.1);
  for (int i = 301; i <= 340; ++i) {
    frozen.t = at_s(0.1 * i);
    push(frozen);
  }
  EXPECT_EQ(quality(), Quality::Doubtful);
  EXPECT_EQ(std::get<std::string>(last().assessment.reasons.front().values.front().value),
            "frozen");
  EXPECT_EQ(health(Gyro).rejected, 36);
}

TEST_F(AttitudeGyroTest, WhatNothingHoldsIsDoubtfulAboveTenDegreesAndLostInTheEnd) {
  track_stars(30.0);
  GyroSample saturated{.t = at_s(31.0), .rate_body_rad_s = Vector3d::Constant(1.0)};
  bool was_open = false;
  for (int second = 31; second < 1500 && quality() != Quality::Lost; ++second) {
    saturated.t = at_s(second);
    push(saturated);
    if (!was_open && sigma_deg() >= 12.0) {
      EXPECT_TRUE(says(ReasonCode::AttitudeOpen));
      was_open = true;
    }
  }
  EXPECT_TRUE(was_open);
  EXPECT_EQ(quality(), Quality::Lost);
  EXPECT_TRUE(says(ReasonCode::NoGyro));
}

TEST_F(AttitudeGyroTest, InDegreesIsNamedAndTheStarFixesAreTheAttitude) {
  run_with_rates_times(kDegPerRad);
  EXPECT_THAT(qualities(), Not(Contains(Quality::Ok)));
  EXPECT_LE(std::ranges::count(qualities(), Quality::Lost), 3);
  EXPECT_EQ(quality(), Quality::Doubtful);
  EXPECT_EQ(last().assessment.reasons.front(),
            (Reason{ReasonCode::GyroUnit, {{"factor", kDegPerRad}}}));
  // Three axes of 20 arcsec exceed five sigma once in 100,000 times.
  EXPECT_LT(error_deg(), degrees(5.0 * std::sqrt(3.0) * config_.star_tracker->noise_rad));
}

TEST_F(AttitudeGyroTest, BeyondItsRangeIsNoGyro) {
  config_.gyro->range_rad_s = 1e-4;
  estimator_ = AttitudeEstimator{config_};
  run_with_rates_times(1.0);
  ASSERT_FALSE(estimates().empty());
  EXPECT_THAT(qualities(), Each(Quality::Doubtful));
  for (const AttitudeEstimate& estimate : estimates()) {
    ASSERT_EQ(
        estimate.assessment.reasons.front(),
        (Reason{ReasonCode::NoGyro, {{"why", "saturated"}, {"since_tai_ns", kStart_tai_ns}}}));
  }
}

/// A step of the rate makes a sample wait for the next one, with two measurements at its time.
TEST_F(AttitudeGyroTest, AtTheInstantOfASampleTheAttitudeIsFinite) {
  const TurningBody body{Eigen::Quaterniond::Identity(), 10.0, [](double t_s) {
                           return Vector3d{t_s < 4.99 ? 0.0 : 0.1, 0.0, 0.0};
                         }};
  Sensors sensors{body, config_, rng_};
  for (int i = 0; i < 40; ++i) {
    push(sensors.gyro(0.25 * i));
    if (i == 20) {
      see(5.0, Sun, sensors.direction(5.0, sun_icrf_, kDirection_rad));
      push(sensors.star(5.0));
    }
  }
  for (const AttitudeEstimate& estimate : estimates()) {
    ASSERT_TRUE(estimate.rate_body_rad_s.value().allFinite());
  }
  EXPECT_GT(estimates().size(), 10U);
}

}  // namespace spindrift::testing::attitude_gyro_test
