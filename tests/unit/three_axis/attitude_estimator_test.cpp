#include "pipelines/three_axis/attitude_estimator.h"

#include "pipelines/observation/innovation_gate.h"
#include "tests/unit/three_axis/estimated_attitude.h"

namespace spindrift::testing::attitude_estimator_test {

using AttitudeEstimatorTest = EstimatedAttitude;

TEST_F(AttitudeEstimatorTest, GivesTheBiasOfItsGyroOnceASecond) {
  run(0.0, 20.0, {Star});
  std::vector<AttitudeEstimate> with_bias = estimates();
  std::erase_if(with_bias, [](const AttitudeEstimate& one) { return !one.gyro_bias; });
  ASSERT_GT(with_bias.size(), 15U);
  EXPECT_GT(estimates().size(), 5 * with_bias.size());
  for (std::size_t i = 1; i < with_bias.size(); ++i) {
    EXPECT_GE(with_bias[i].t - with_bias[i - 1].t, std::chrono::seconds{1});
  }
  EXPECT_LT(with_bias.back().gyro_bias->covariance_rad2_s2.trace(),
            with_bias.front().gyro_bias->covariance_rad2_s2.trace());
}

TEST_F(AttitudeEstimatorTest, TwoDirectionsThatContradictEachOtherBeginNothing) {
  gyro(0.0);
  sun(0.0);
  // The field is reported twenty degrees nearer to the Sun than it is.
  const Vector3d nearer = (field_icrf_ + 0.35 * sun_icrf_).normalized();
  see(0.0, Magnetometer, sensors_.direction(0.0, nearer, 0.0));
  EXPECT_FALSE(estimator_.filter());
  run(0.0, 1.0, {Sun, Magnetometer});
  estimator_.settle(products_);
  EXPECT_TRUE(estimator_.filter());
}

TEST_F(AttitudeEstimatorTest, BeforeTheFirstFixThereIsNothing) {
  run(0.0, 10.0, {Sun});
  estimator_.settle(products_);
  EXPECT_TRUE(products_.empty());
  EXPECT_FALSE(estimator_.ever_began());
  EXPECT_EQ(health(Sun).accepted, 10);
}

TEST_F(AttitudeEstimatorTest, BeforeTheFirstAttitudeItTellsThatSensorsContradictEachOther) {
  gyro(0.0);
  run(0.0, 10.0, [&](double t_s) {
    direction(t_s, Sun, quaternion_by({0.0, 0.0, 0.5}));
    field(t_s);
  });
  EXPECT_TRUE(estimates().empty());
  const auto told = of_kind<SensorsCompared>(products_);
  ASSERT_FALSE(told.empty());
  EXPECT_LE(seconds_between(at_s(0.0), told.front().t), 6.0);
  EXPECT_TRUE(told.front().contradiction);
}

TEST_F(AttitudeEstimatorTest, TheFirstStarFixIsGivenAtOnce) {
  star(0.05);
  ASSERT_EQ(estimates().size(), 1U);
  EXPECT_EQ(quality(), Quality::Converging);
  EXPECT_EQ(last().t, at_s(0.05));
  EXPECT_FALSE(last().rate_body_rad_s);
  EXPECT_NEAR(last().sigma_rad(), std::sqrt(3.0) * config_.star_tracker->noise_rad, 1e-12);
  EXPECT_LT(error_deg(), 0.03);
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
  // The attitude is propagated over 1.9 s in which the body has rotated by several degrees.
  EXPECT_LT(error_deg(), 3.0 * sigma_deg());
  EXPECT_LT(sigma_deg(), 2.0);
}

TEST_F(AttitudeEstimatorTest, DirectionsTooFarApartInTimeDoNotBegin) {
  gyro(0.0);
  sun(0.0);
  run(0.0, 6.0, [](double) {});
  field(6.0);
  EXPECT_TRUE(estimates().empty());
}

TEST_F(AttitudeEstimatorTest, IsCheckedByTenStarFixes) {
  track_stars(9.0);
  EXPECT_EQ(quality(), Quality::Converging);
  run(9.0, 11.0, {Star});
  EXPECT_EQ(quality(), Quality::Ok);
  EXPECT_TRUE(last().assessment.reasons.empty());
  EXPECT_LT(error_deg(), 3.0 * sigma_deg());
}

TEST_F(AttitudeEstimatorTest, TheSunAloneChecksNoTurnAboutIt) {
  begin();
  run(0.0, 60.0, {Sun});
  EXPECT_EQ(quality(), Quality::Converging);
  run(60.0, 100.0, {Sun, Magnetometer});
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
  track_stars(20.0);
  products_.clear();
  star(20.0, {0.01, 0.0, 0.0});
  ASSERT_EQ(products_.size(), 2U);
  const Observation& said = std::get<SampleObservation>(products_.front()).said;
  EXPECT_EQ(said.source, SampleSource::Star);
  EXPECT_EQ(said.rejected_by, Rejection::Innovation);
  EXPECT_NEAR(said.residual.value.norm(), 0.01, 1e-3);
  const auto& rejected = std::get<RejectedSample>(products_.back());
  EXPECT_EQ(rejected.failed.value().value, said.nis);
  EXPECT_EQ(rejected.failed->limit, said.limit);
  EXPECT_EQ(rejected.kind, Star);
  EXPECT_EQ(rejected.rejected_by, Rejection::Innovation);
  EXPECT_GT(said.nis, innovation_gate(3));
  EXPECT_EQ(health(Star).rejected, 1);
  EXPECT_EQ(health(Star).rejected_in_a_row, 1);
  run(20.0, 30.0, {Star});
  EXPECT_EQ(health(Star).rejected_in_a_row, 0);
  EXPECT_EQ(quality(), Quality::Ok);
}

TEST_F(AttitudeEstimatorTest, FixesThatAgreeOverruleAFalseFirstOne) {
  begin({0.0, 0.5, 0.3});
  run(0.0, 2.0, {Star});
  EXPECT_GT(error_deg(), 20.0);
  run(2.0, 14.0, {Star});
  EXPECT_LT(error_deg(), 0.03);
  EXPECT_EQ(quality(), Quality::Ok);
  ASSERT_TRUE(says(ReasonCode::Since));
  EXPECT_EQ(last().assessment.reasons.back().values.front().value,
            NamedValue::Value{tai_ns(at_s(3.0))});
}

TEST_F(AttitudeEstimatorTest, AStuckTrackerOverrulesNothing) {
  begin();
  run(0.0, 20.0, {Star, Sun});
  StarFix stuck = sensors_.star(20.0);
  run(20.0, 40.0, [&](double t_s) {
    stuck.t = at_s(t_s);
    push(stuck);
    sun(t_s);
    field(t_s);
  });
  EXPECT_LT(error_deg(), 0.1);
  EXPECT_LT(error_deg(), 3.0 * sigma_deg());
  // The other sensors hold the attitude, and the faulty sensor is known.
  EXPECT_EQ(quality(), Quality::Ok);
  EXPECT_TRUE(says(ReasonCode::SensorGated));
  EXPECT_FALSE(says(ReasonCode::Since));
  EXPECT_EQ(rejected(Star, Rejection::Frozen), 19);
}

/// A body at 0.005 deg/s moves by less than the noise of a fix.
TEST_F(AttitudeEstimatorTest, AStuckTrackerDoesNotStopASlowBody) {
  const TurningBody slow{any_attitude(rng_), kLong_s, [](double) {
                           return Vector3d{5e-5, 5e-5, -5e-5};
                         }};
  Sensors sensors{slow, config_, rng_};
  StarFix stuck;
  for (int i = 0; i < 4 * 100; ++i) {
    const double t_s = 0.25 * i;
    estimator_.push(sensors.gyro(t_s), products_);
    if (i % 4 == 0) {
      StarFix fix = t_s < 30.0 ? sensors.star(t_s) : stuck;
      stuck = fix;
      fix.t = at_s(t_s);
      // A quaternion may have either sign.
      fix.q_icrf_sensor.coeffs() *= i % 8 == 0 ? 1.0 : -1.0;
      push(fix);
    }
  }
  for (const AttitudeEstimate& row : estimates()) {
    const double off_rad = error_rad(row.q_icrf_body, slow.q_icrf_body(seconds_of(row))).norm();
    EXPECT_LT(off_rad, 5.0 * row.sigma_rad()) << seconds_of(row);
  }
  EXPECT_EQ(rejected(Star, Rejection::Frozen), 70);
  EXPECT_TRUE(says(ReasonCode::SensorGated));
}

TEST_F(AttitudeEstimatorTest, ATurnedTrackerDoesNotOverruleWhatSunAndFieldConfirm) {
  begin();
  // Sun and field come once in five seconds each; there are more false fixes than make the attitude
  // lost.
  run(0.0, 110.0, [&](double t_s) {
    star(t_s, t_s <= 60.0 ? kNone : kTurned_rad);
    const int second = static_cast<int>(std::lround(t_s));
    if (second % 5 == 0) {
      sun(t_s);
    } else if (second % 5 == 2) {
      field(t_s);
    }
  });
  EXPECT_THAT(qualities(), Not(Contains(Quality::Lost)));
  for (const AttitudeEstimate& row : estimates()) {
    EXPECT_FALSE(has(row.assessment, ReasonCode::Since));
    EXPECT_LT(error_deg(row), 5.0 * degrees(row.sigma_rad())) << seconds_of(row);
  }
  EXPECT_EQ(quality(), Quality::Ok);
  EXPECT_THAT(last().assessment.reasons,
              ElementsAre(Reason{ReasonCode::SensorGated, {{"sensor", "star"}}}));
  EXPECT_EQ(rejected(Star, Rejection::Innovation), 50);
}

/// The gyro alone cannot tell whether the tracker was wrong before or is wrong now.
TEST_F(AttitudeEstimatorTest, WithoutSunAndFieldATurnedTrackerIsDoubtfulUntilItReturns) {
  track_stars(30.0);
  EXPECT_EQ(quality(), Quality::Ok);
  run(30.0, 60.0, {Star}, kTurned_rad);
  for (const AttitudeEstimate& row : estimates()) {
    if (row.assessment.quality == Quality::Ok) {
      EXPECT_LT(error_deg(row), 1.0);
    }
  }
  EXPECT_EQ(quality(), Quality::Doubtful);
  EXPECT_TRUE(says(ReasonCode::StarFixesContradict));
  EXPECT_LT(error_deg(), 1.0);
  // In the end the estimator follows the tracker.
  run(60.0, 80.0, {Star}, kTurned_rad);
  EXPECT_EQ(quality(), Quality::Doubtful);
  EXPECT_TRUE(says(ReasonCode::StarFixesContradict));
  EXPECT_GT(error_deg(), 4.0);
  run(80.0, 100.0, {Star});
  EXPECT_EQ(quality(), Quality::Ok);
  EXPECT_LT(error_deg(), 0.03);
}

TEST_F(AttitudeEstimatorTest, ATurnedTrackerIsNotOkAgainByItsOwnFixes) {
  track_stars(20.0);
  // Ten fixes that agree with nothing make the attitude lost.
  run(20.0, 31.0, [&](double t_s) {
    StarFix junk = sensors_.star(t_s);
    junk.q_icrf_sensor = any_attitude(rng_);
    push(junk);
  });
  EXPECT_THAT(qualities(), Contains(Quality::Lost));
  products_.clear();
  run(31.0, 110.0, {Star}, kTurned_rad);
  EXPECT_THAT(qualities(), Not(Contains(Quality::Ok)));
  EXPECT_TRUE(says(ReasonCode::StarFixesContradict));
  // Sun and field confirm the fixes: the attitude before was wrong.
  run(110.0, 115.0, [&](double t_s) {
    star(t_s, kTurned_rad);
    direction(t_s, Sun, quaternion_by(kTurned_rad));
    direction(t_s, Magnetometer, quaternion_by(kTurned_rad));
  });
  EXPECT_EQ(quality(), Quality::Ok);
}

TEST_F(AttitudeEstimatorTest, SunAndFieldProveAFixThatTheAttitudeRejects) {
  begin(kTurned_rad);
  run(0.0, 30.0, {Star, Sun, Magnetometer}, kTurned_rad);
  EXPECT_THAT(qualities(), Not(Contains(Quality::Ok)));
  run(30.0, 33.0, {Star, Sun, Magnetometer});
  EXPECT_LT(error_deg(), 0.03);
  run(33.0, 45.0, {Star, Sun, Magnetometer});
  EXPECT_EQ(quality(), Quality::Ok);
}

/// A magnetometer is misaligned by 6 deg about the Sun and contradicts the tracker.
TEST_F(AttitudeEstimatorTest, FixesThatContradictWhatTheyNeverSaidAreDoubtful) {
  const Eigen::Quaterniond off{Eigen::AngleAxisd{6.0 * kRadPerDeg, sun_icrf_}};
  gyro(0.0);
  run(0.0, 60.0, [&](double t_s) {
    sun(t_s);
    direction(t_s, Magnetometer, off);
  });
  EXPECT_GT(error_deg(), 4.0);
  products_.clear();
  run(60.0, 110.0, [&](double t_s) {
    star(t_s);
    sun(t_s);
    direction(t_s, Magnetometer, off);
  });
  for (const AttitudeEstimate& row : estimates()) {
    if (seconds_of(row) > 70.0) {
      EXPECT_EQ(row.assessment.quality, Quality::Doubtful) << seconds_of(row);
    }
  }
  EXPECT_TRUE(says(ReasonCode::SensorGated));
}

TEST_F(AttitudeEstimatorTest, AStuckFieldIsNamedAndTheOthersHoldTheAttitude) {
  begin();
  run(0.0, 20.0, {Star, Sun, Magnetometer});
  run(20.0, 60.0, [&](double t_s) {
    star(t_s);
    sun(t_s);
    see(t_s, Magnetometer, {0.9, -0.3, 0.2});
  });
  EXPECT_EQ(quality(), Quality::Ok);
  EXPECT_THAT(last().assessment.reasons,
              ElementsAre(Reason{ReasonCode::SensorGated, {{"sensor", "magnetometer"}}}));
  EXPECT_EQ(rejected(Magnetometer, Rejection::Frozen), 39);
  EXPECT_LT(error_deg(), 0.03);
}

/// One sample of a sensor that was never accepted prevents trust in the others.
TEST_F(AttitudeEstimatorTest, IsNotOkWhileAllOfASensorIsRejected) {
  begin(kTurned_rad);
  run(0.0, 30.0, [&](double t_s) {
    star(t_s, kTurned_rad);
    if (std::lround(t_s) % 10 == 5) {
      field(t_s);
    }
  });
  EXPECT_EQ(health(Magnetometer).accepted, 0);
  EXPECT_EQ(quality(), Quality::Converging);
}

TEST_F(AttitudeEstimatorTest, WhereAllIsRejectedItIsLostAndBeginsAtTheNextFix) {
  track_stars(20.0);
  // The Sun is reported elsewhere, and there are no star fixes.
  run(20.0, 30.5,
      [&](double t_s) { see(t_s, Sun, body_.q_icrf_body(t_s).conjugate() * field_icrf_); });
  const AttitudeEstimate lost = last();
  EXPECT_EQ(lost.assessment.quality, Quality::Lost);
  EXPECT_TRUE(has(lost.assessment, ReasonCode::AwaitingFix));
  EXPECT_GT(degrees(lost.sigma_rad()), 100.0);
  EXPECT_FALSE(estimator_.filter());
  run(30.5, 40.0, [](double) {});
  EXPECT_EQ(last().t, lost.t);
  star(40.0);
  EXPECT_EQ(quality(), Quality::Converging);
  EXPECT_TRUE(says(ReasonCode::Since));
  EXPECT_LT(error_deg(), 0.03);
}

TEST_F(AttitudeEstimatorTest, WithoutStarFixesNoneContradictEachOther) {
  gyro(0.0);
  run(0.0, 30.0, {Sun, Magnetometer});
  run(30.0, 60.0, [&](double t_s) {
    direction(t_s, Sun, quaternion_by({0.4, 0.4, 0.0}));
    direction(t_s, Magnetometer, quaternion_by({0.4, 0.4, 0.0}));
  });
  EXPECT_THAT(qualities(), Contains(Quality::Lost));
  for (const AttitudeEstimate& row : estimates()) {
    EXPECT_FALSE(has(row.assessment, ReasonCode::StarFixesContradict));
  }
}

/// Loses the attitude to ten fixes that agree with nothing.
class LostAttitudeTest : public EstimatedAttitude {
 protected:
  void lose() {
    track_stars(20.0);
    run(20.0, 31.0, [&](double t_s) {
      StarFix junk = sensors_.star(t_s);
      junk.q_icrf_sensor = any_attitude(rng_);
      push(junk);
    });
    ASSERT_THAT(qualities(), Contains(Quality::Lost));
    products_.clear();
  }
};

TEST_F(LostAttitudeTest, IsNotOkByTheSameSensorAloneForAMinute) {
  lose();
  run(31.0, 85.0, {Star});
  EXPECT_THAT(qualities(), Not(Contains(Quality::Ok)));
  EXPECT_GT(sigma_deg(), 30.0);
  EXPECT_LT(error_deg(), 0.03);
  run(85.0, 105.0, {Star});
  EXPECT_EQ(quality(), Quality::Ok);
  EXPECT_LT(sigma_deg(), 0.1);
}

TEST_F(LostAttitudeTest, IsOkOnceASecondKindOfSensorConfirmsTheNextOne) {
  lose();
  run(31.0, 60.0, {Star, Sun});
  EXPECT_EQ(quality(), Quality::Ok);
  EXPECT_LT(sigma_deg(), 0.1);
}

TEST_F(AttitudeEstimatorTest, AfterARejectedFixItIsNotOkUntilTheNext) {
  track_stars(20.0);
  star(20.05, {0.01, 0.0, 0.0});
  run(20.0, 20.9, [](double) {});
  EXPECT_EQ(quality(), Quality::Converging);
  run(20.9, 21.1, {Star});
  EXPECT_EQ(quality(), Quality::Ok);
}

TEST_F(AttitudeEstimatorTest, NoiseBeyondTheStatedIsSaidAndInTheSigma) {
  begin();
  ThreeAxisConfig noisy = config_;
  noisy.star_tracker->noise_rad *= 2.0;
  Sensors worse{body_, noisy, rng_};
  run(0.0, 100.0, [&](double t_s) { push(worse.star(t_s)); });
  EXPECT_EQ(quality(), Quality::Doubtful);
  ASSERT_TRUE(says(ReasonCode::SensorNoise));
  const Reason noise = last().assessment.reasons.front();
  EXPECT_EQ(std::get<std::string>(noise.values[0].value), "star");
  EXPECT_NEAR(std::get<double>(noise.values[1].value), 1.8, 0.3);
}

}  // namespace spindrift::testing::attitude_estimator_test
