#include "pipelines/three_axis/attitude_estimator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <random>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/rotation_vector.h"
#include "pipelines/observation/innovation_gate.h"
#include "tests/support/of_kind.h"
#include "tests/support/turning_body.h"

namespace spindrift::attitude_estimator_test {

using Eigen::Vector3d;
using testing::at_s;
using testing::error_rad;
using testing::Sensors;
using testing::TurningBody;
using testing::usual_three_axis;
using enum SampleKind;

/// Simulates a pass of two minutes with the sensors that a test selects.
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
  StarFix turned_fix(double t_s) {
    StarFix fix = sensors_.star(t_s);
    fix.q_icrf_sensor = quaternion_by({0.05, -0.05, 0.05}) * fix.q_icrf_sensor;
    return fix;
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
  /// Pushes a direction as seen by a body rotated in ICRF.
  void direction_of(const Eigen::Quaterniond& turned, double t_s, SampleKind kind,
                    const Vector3d& ref_icrf) {
    constexpr double kSigma_rad = 0.5 * kRadPerDeg;
    estimator_.push(
        SeenDirection{at_s(t_s),
                      kind,
                      {sensors_.direction(t_s, turned.conjugate() * ref_icrf, kSigma_rad), ref_icrf,
                       kSigma_rad}},
        products_);
  }
  void sun(double t_s) { direction(t_s, Sun, sun_icrf_, config_.sun_sensor->noise_rad); }
  void field(double t_s) { direction(t_s, Magnetometer, field_icrf_, 0.5 * kRadPerDeg); }

  /// Pushes the gyro at 10 Hz from 0.1 s after `from_s` on and calls `at_second` at whole seconds
  /// after it.
  void run(double from_s, double to_s, const std::function<void(double)>& at_second) {
    for (int i = static_cast<int>(std::lround(from_s * 10.0)) + 1; i <= std::lround(to_s * 10.0);
         ++i) {
      gyro(0.1 * i);
      if (i % 10 == 0) {
        at_second(0.1 * i);
      }
    }
  }

  /// Gives a sample of each of these sensors once a second.
  void run(double from_s, double to_s, std::initializer_list<SampleKind> at_second) {
    run(from_s, to_s, [&](double t_s) {
      for (const SampleKind kind : at_second) {
        kind == Star ? star(t_s) : kind == Sun ? sun(t_s) : field(t_s);
      }
    });
  }
  /// Begins with a star fix, and has one a second.
  void track_stars(double to_s) {
    gyro(0.0);
    star(0.0);
    run(0.0, to_s, {Star});
  }

  std::vector<AttitudeEstimate> estimates() const { return of_kind<AttitudeEstimate>(products_); }
  AttitudeEstimate last() const { return estimates().back(); }
  Quality quality() const { return last().assessment.quality; }
  double seconds_of(const AttitudeEstimate& estimate) const {
    return seconds_between(at_s(0.0), estimate.t);
  }
  double error_deg(const AttitudeEstimate& estimate) const {
    const double t_s = std::round(seconds_of(estimate) * 1e3) * 1e-3;
    return degrees(error_rad(estimate.q_icrf_body, body_.q_icrf_body(t_s)).norm());
  }
  std::int64_t rejected(SampleKind kind, Rejection rejected_by) const {
    const auto samples = of_kind<RejectedSample>(products_);
    return std::count_if(samples.begin(), samples.end(), [&](const RejectedSample& sample) {
      return sample.kind == kind && sample.rejected_by == rejected_by;
    });
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

TEST_F(AttitudeEstimatorTest, GivesTheBiasOfItsGyroOnceASecond) {
  run(0.0, 20.0, {Star});
  std::vector<AttitudeEstimate> with_bias = estimates();
  const std::size_t all = with_bias.size();
  std::erase_if(with_bias, [](const AttitudeEstimate& one) { return !one.gyro_bias; });
  ASSERT_GT(with_bias.size(), 15U);
  EXPECT_GT(all, 5 * with_bias.size());
  for (std::size_t i = 1; i < with_bias.size(); ++i) {
    EXPECT_GE(with_bias[i].t - with_bias[i - 1].t, std::chrono::seconds{1});
  }
  const auto variances = [&](std::size_t i) {
    return with_bias[i].gyro_bias->covariance_rad2_s2.trace();
  };
  EXPECT_LT(variances(with_bias.size() - 1), variances(0));
}

TEST_F(AttitudeEstimatorTest, TwoDirectionsThatContradictEachOtherBeginNothing) {
  gyro(0.0);
  sun(0.0);
  // The field is reported twenty degrees nearer to the Sun than it is.
  const Vector3d nearer = (field_icrf_ + 0.35 * sun_icrf_).normalized();
  estimator_.push(SeenDirection{.t = at_s(0.0),
                                .kind = Magnetometer,
                                .direction = {.body = sensors_.direction(0.0, nearer, 0.0),
                                              .ref = field_icrf_,
                                              .sigma_rad = 0.5 * kRadPerDeg}},
                  products_);
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
  // The attitude is propagated over 1.9 s in which the body has rotated by several degrees.
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
  track_stars(9.0);
  EXPECT_EQ(quality(), Quality::Converging);
  run(9.0, 11.0, {Star});
  EXPECT_EQ(quality(), Quality::Ok);
  EXPECT_TRUE(last().assessment.reasons.empty());
  EXPECT_LT(error_deg(last()), 3.0 * degrees(last().sigma_rad()));
}

TEST_F(AttitudeEstimatorTest, TheSunAloneChecksNoTurnAboutIt) {
  gyro(0.0);
  star(0.0);
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
  gyro(0.0);
  star(0.0, {0.0, 0.5, 0.3});
  run(0.0, 2.0, {Star});
  EXPECT_GT(error_deg(last()), 20.0);
  run(2.0, 14.0, {Star});
  EXPECT_LT(error_deg(last()), 0.03);
  EXPECT_EQ(quality(), Quality::Ok);
  ASSERT_TRUE(has(last().assessment, ReasonCode::Since));
  EXPECT_EQ(last().assessment.reasons.back().values.front().value,
            NamedValue::Value{tai_ns(at_s(3.0))});
}

TEST_F(AttitudeEstimatorTest, AStuckTrackerOverrulesNothing) {
  gyro(0.0);
  star(0.0);
  run(0.0, 20.0, {Star, Sun});
  StarFix stuck = sensors_.star(20.0);
  run(20.0, 40.0, [&](double t_s) {
    stuck.t = at_s(t_s);
    estimator_.push(stuck, products_);
    sun(t_s);
    field(t_s);
  });
  EXPECT_LT(error_deg(last()), 0.1);
  EXPECT_LT(error_deg(last()), 3.0 * degrees(last().sigma_rad()));
  // The other sensors hold the attitude, and the faulty sensor is known.
  EXPECT_EQ(quality(), Quality::Ok);
  EXPECT_TRUE(has(last().assessment, ReasonCode::SensorGated));
  EXPECT_FALSE(has(last().assessment, ReasonCode::Since));
  EXPECT_EQ(rejected(Star, Rejection::Frozen), 19);
}

/// A body at 0.005 deg/s moves by less than the noise of a fix.
TEST_F(AttitudeEstimatorTest, AStuckTrackerDoesNotStopASlowBody) {
  const TurningBody slow{testing::any_attitude(rng_), kLong_s, [](double) {
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
      estimator_.push(fix, products_);
    }
  }
  for (const AttitudeEstimate& row : estimates()) {
    const double off_rad = error_rad(row.q_icrf_body, slow.q_icrf_body(seconds_of(row))).norm();
    EXPECT_LT(off_rad, 5.0 * row.sigma_rad()) << seconds_of(row);
  }
  EXPECT_EQ(rejected(Star, Rejection::Frozen), 70);
  EXPECT_TRUE(has(last().assessment, ReasonCode::SensorGated));
}

TEST_F(AttitudeEstimatorTest, ATurnedTrackerDoesNotOverruleWhatSunAndFieldConfirm) {
  gyro(0.0);
  star(0.0);
  // Sun and field come once in five seconds each; there are more false fixes than make the attitude
  // lost.
  run(0.0, 110.0, [&](double t_s) {
    if (t_s <= 60.0) {
      star(t_s);
    } else {
      estimator_.push(turned_fix(t_s), products_);
    }
    const int second = static_cast<int>(std::lround(t_s));
    if (second % 5 == 0) {
      sun(t_s);
    } else if (second % 5 == 2) {
      field(t_s);
    }
  });
  for (const AttitudeEstimate& row : estimates()) {
    EXPECT_NE(row.assessment.quality, Quality::Lost);
    EXPECT_FALSE(has(row.assessment, ReasonCode::Since));
    EXPECT_LT(error_deg(row), 5.0 * degrees(row.sigma_rad())) << seconds_of(row);
  }
  EXPECT_EQ(quality(), Quality::Ok);
  EXPECT_EQ(last().assessment.reasons,
            (std::vector{Reason{ReasonCode::SensorGated, {{"sensor", std::string{"star"}}}}}));
  EXPECT_EQ(rejected(Star, Rejection::Innovation), 50);
}

/// The gyro alone cannot tell whether the tracker was wrong before or is wrong now.
TEST_F(AttitudeEstimatorTest, WithoutSunAndFieldATurnedTrackerIsDoubtfulUntilItReturns) {
  track_stars(30.0);
  EXPECT_EQ(quality(), Quality::Ok);
  run(30.0, 60.0, [&](double t_s) { estimator_.push(turned_fix(t_s), products_); });
  for (const AttitudeEstimate& row : estimates()) {
    if (row.assessment.quality == Quality::Ok) {
      EXPECT_LT(error_deg(row), 1.0);
    }
  }
  EXPECT_EQ(quality(), Quality::Doubtful);
  EXPECT_TRUE(has(last().assessment, ReasonCode::StarFixesContradict));
  EXPECT_LT(error_deg(last()), 1.0);
  // In the end the estimator follows the tracker.
  run(60.0, 80.0, [&](double t_s) { estimator_.push(turned_fix(t_s), products_); });
  EXPECT_EQ(quality(), Quality::Doubtful);
  EXPECT_TRUE(has(last().assessment, ReasonCode::StarFixesContradict));
  EXPECT_GT(error_deg(last()), 4.0);
  run(80.0, 100.0, {Star});
  EXPECT_EQ(quality(), Quality::Ok);
  EXPECT_LT(error_deg(last()), 0.03);
}

TEST_F(AttitudeEstimatorTest, ATurnedTrackerIsNotOkAgainByItsOwnFixes) {
  track_stars(20.0);
  // Ten fixes that agree with nothing make the attitude lost.
  run(20.0, 31.0, [&](double t_s) {
    StarFix junk = sensors_.star(t_s);
    junk.q_icrf_sensor = testing::any_attitude(rng_);
    estimator_.push(junk, products_);
  });
  const auto lost = estimates();
  EXPECT_TRUE(std::any_of(lost.begin(), lost.end(), [](const AttitudeEstimate& row) {
    return row.assessment.quality == Quality::Lost;
  }));
  products_.clear();
  run(31.0, 110.0, [&](double t_s) { estimator_.push(turned_fix(t_s), products_); });
  for (const AttitudeEstimate& row : estimates()) {
    EXPECT_NE(row.assessment.quality, Quality::Ok) << seconds_of(row);
  }
  EXPECT_TRUE(has(last().assessment, ReasonCode::StarFixesContradict));
  // Sun and field confirm the fixes: the attitude before was wrong.
  const Eigen::Quaterniond turned =
      turned_fix(110.0).q_icrf_sensor * sensors_.star(110.0).q_icrf_sensor.conjugate();
  run(110.0, 115.0, [&](double t_s) {
    estimator_.push(turned_fix(t_s), products_);
    direction_of(turned, t_s, Sun, sun_icrf_);
    direction_of(turned, t_s, Magnetometer, field_icrf_);
  });
  EXPECT_EQ(quality(), Quality::Ok);
}

TEST_F(AttitudeEstimatorTest, SunAndFieldProveAFixThatTheAttitudeRejects) {
  gyro(0.0);
  estimator_.push(turned_fix(0.0), products_);
  run(0.0, 30.0, [&](double t_s) {
    estimator_.push(turned_fix(t_s), products_);
    sun(t_s);
    field(t_s);
  });
  for (const AttitudeEstimate& row : estimates()) {
    EXPECT_NE(row.assessment.quality, Quality::Ok) << seconds_of(row);
  }
  run(30.0, 33.0, {Star, Sun, Magnetometer});
  EXPECT_LT(error_deg(last()), 0.03);
  run(33.0, 45.0, {Star, Sun, Magnetometer});
  EXPECT_EQ(quality(), Quality::Ok);
}

/// A magnetometer is misaligned by 6 deg about the Sun and contradicts the tracker.
TEST_F(AttitudeEstimatorTest, FixesThatContradictWhatTheyNeverSaidAreDoubtful) {
  const Eigen::Quaterniond off{Eigen::AngleAxisd{6.0 * kRadPerDeg, sun_icrf_}};
  gyro(0.0);
  run(0.0, 60.0, [&](double t_s) {
    sun(t_s);
    direction_of(off, t_s, Magnetometer, field_icrf_);
  });
  EXPECT_GT(error_deg(last()), 4.0);
  products_.clear();
  run(60.0, 110.0, [&](double t_s) {
    star(t_s);
    sun(t_s);
    direction_of(off, t_s, Magnetometer, field_icrf_);
  });
  for (const AttitudeEstimate& row : estimates()) {
    if (seconds_of(row) > 70.0) {
      EXPECT_EQ(row.assessment.quality, Quality::Doubtful) << seconds_of(row);
    }
  }
  EXPECT_TRUE(has(last().assessment, ReasonCode::SensorGated));
}

TEST_F(AttitudeEstimatorTest, AStuckFieldIsNamedAndTheOthersHoldTheAttitude) {
  gyro(0.0);
  star(0.0);
  run(0.0, 20.0, {Star, Sun, Magnetometer});
  const Vector3d stuck = Vector3d{0.9, -0.3, 0.2};
  run(20.0, 60.0, [&](double t_s) {
    star(t_s);
    sun(t_s);
    estimator_.push(SeenDirection{at_s(t_s), Magnetometer, {stuck, field_icrf_, 0.01}}, products_);
  });
  EXPECT_EQ(quality(), Quality::Ok);
  EXPECT_EQ(
      last().assessment.reasons,
      (std::vector{Reason{ReasonCode::SensorGated, {{"sensor", std::string{"magnetometer"}}}}}));
  EXPECT_EQ(rejected(Magnetometer, Rejection::Frozen), 39);
  EXPECT_LT(error_deg(last()), 0.03);
}

/// One sample of a sensor that was never accepted prevents trust in the others.
TEST_F(AttitudeEstimatorTest, IsNotOkWhileAllOfASensorIsRejected) {
  gyro(0.0);
  estimator_.push(turned_fix(0.0), products_);
  run(0.0, 30.0, [&](double t_s) {
    estimator_.push(turned_fix(t_s), products_);
    if (std::lround(t_s) % 10 == 5) {
      field(t_s);
    }
  });
  EXPECT_EQ(health(Magnetometer).accepted, 0);
  EXPECT_EQ(quality(), Quality::Converging);
}

TEST_F(AttitudeEstimatorTest, WithoutAGyroSunAndFieldOfWithinASecondGiveAnAttitude) {
  for (const double apart_s : {0.0, 0.01, 0.5, 1.0}) {
    SCOPED_TRACE(apart_s);
    estimator_ = AttitudeEstimator{config_};
    products_.clear();
    sun(20.0);
    field(20.0 + apart_s);
    ASSERT_EQ(estimates().size(), 1U);
    EXPECT_EQ(last().t, at_s(20.0 + apart_s));
    EXPECT_FALSE(last().rate_body_rad_s);
    EXPECT_EQ(quality(), Quality::Converging);
    // Two directions of 0.5 deg nearly perpendicular to each other, the first moved by 5 deg/s
    // about each axis.
    const double sun_deg = std::hypot(0.5, 5.0 * apart_s);
    const double along_both_deg = 1.0 / std::hypot(1.0 / sun_deg, 1.0 / 0.5);
    EXPECT_NEAR(degrees(last().sigma_rad()), std::hypot(0.5, sun_deg, along_both_deg),
                0.05 * sun_deg);
    EXPECT_LT(error_deg(last()), 4.0 * degrees(last().sigma_rad()));
  }
  estimator_ = AttitudeEstimator{config_};
  products_.clear();
  sun(20.0);
  field(21.005);
  EXPECT_TRUE(estimates().empty());
}

TEST_F(AttitudeEstimatorTest, WithoutAGyroEachPairOfDirectionsIsAnAttitudeAndAStarFixABetterOne) {
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
  EXPECT_LT(degrees(last().sigma_rad()), 0.02);
}

TEST_F(AttitudeEstimatorTest, WhereAllIsRejectedItIsLostAndBeginsAtTheNextFix) {
  track_stars(20.0);
  // The Sun is reported elsewhere, and there are no star fixes.
  run(20.0, 30.5, [&](double t_s) {
    estimator_.push(
        SeenDirection{.t = at_s(t_s),
                      .kind = Sun,
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
  track_stars(30.0);
  const double before_deg = degrees(last().sigma_rad());
  // The gyro is silent for 12 s.
  gyro(42.0);
  EXPECT_GT(degrees(last().sigma_rad()), 20.0 * before_deg);
  EXPECT_LT(error_deg(last()), 3.0 * degrees(last().sigma_rad()));
  EXPECT_TRUE(last().rate_body_rad_s);
  EXPECT_EQ(quality(), Quality::Doubtful);
  EXPECT_EQ(last().assessment.reasons.front(),
            (Reason{ReasonCode::GyroGaps, {{"count", std::int64_t{1}}, {"longest_s", 12.0}}}));
  run(42.0, 60.0, {Star});
  EXPECT_EQ(quality(), Quality::Ok);
  EXPECT_LT(degrees(last().sigma_rad()), 2.0 * before_deg);
  EXPECT_EQ(health(Star).rejected, 0);
}

TEST_F(AttitudeEstimatorTest, WithoutGyroTheLastRateIsHeldAndTheEstimateSaysSo) {
  track_stars(30.0);
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
  track_stars(30.0);
  star(36.0);
  const double at_fix_deg = degrees(last().sigma_rad());
  gyro(40.0);
  EXPECT_EQ(last().t, at_s(40.0));
  EXPECT_GT(degrees(last().sigma_rad()), 50.0 * at_fix_deg);
  EXPECT_LT(error_deg(last()), 3.0 * degrees(last().sigma_rad()));
  run(40.0, 55.0, {Star});
  EXPECT_EQ(quality(), Quality::Ok);
  EXPECT_EQ(health(Star).rejected, 0);
}

/// The body rotates by 30 deg in the gap and is at rest before and after.
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
    EXPECT_EQ(estimator.sensors().at(index_of(Gyro)).rejected, 1);
    EXPECT_LT(degrees(angle_between_rad(estimator.filter()->q_icrf_body(),
                                        clean.filter()->q_icrf_body())),
              0.01);
  }
}

/// The rate changes by 1 deg/s within a sample and back, while star fixes continue.
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
    EXPECT_EQ(estimator.sensors().at(index_of(Gyro)).rejected, 0) << samples_on;
  }
}

TEST_F(AttitudeEstimatorTest, AFrozenGyroIsNoGyro) {
  track_stars(30.0);
  GyroSample frozen = sensors_.gyro(30.1);
  for (int i = 301; i <= 340; ++i) {
    frozen.t = at_s(0.1 * i);
    estimator_.push(frozen, products_);
  }
  EXPECT_EQ(quality(), Quality::Doubtful);
  EXPECT_EQ(std::get<std::string>(last().assessment.reasons.front().values.front().value),
            "frozen");
  EXPECT_EQ(health(Gyro).rejected, 36);
}

TEST_F(AttitudeEstimatorTest, WhatNothingHoldsIsDoubtfulAboveTenDegreesAndLostInTheEnd) {
  track_stars(30.0);
  GyroSample saturated{.t = at_s(31.0), .rate_body_rad_s = Vector3d::Constant(1.0)};
  bool was_open = false;
  for (int second = 31; second < 1500 && quality() != Quality::Lost; ++second) {
    saturated.t = at_s(second);
    estimator_.push(saturated, products_);
    if (!was_open && degrees(last().sigma_rad()) >= 12.0) {
      EXPECT_TRUE(has(last().assessment, ReasonCode::AttitudeOpen));
      was_open = true;
    }
  }
  EXPECT_TRUE(was_open);
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
