#include "pipelines/three_axis/carried_directions.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <random>

#include "pipelines/frames/rotation_vector.h"
#include "tests/support/matchers.h"
#include "tests/support/turning_body.h"

namespace spindrift::testing::carried_directions_test {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kSigma_rad = 1e-3;
const Vector3d kSun{1.0, 0.0, 0.0};
const Vector3d kField{0.0, 1.0, 0.0};

ObservedDirection seen(const Quaterniond& q_ref_body, const Vector3d& ref,
                       double sigma_rad = kSigma_rad) {
  return {.body = q_ref_body.conjugate() * ref, .ref = ref, .sigma_rad = sigma_rad};
}

void add(CarriedDirections& carried, SampleKind kind, TaiTime t, const ObservedDirection& direction,
         const Vector3d& rate_rad_s = Vector3d::Zero()) {
  carried.add({.t = t, .kind = kind, .direction = direction}, rate_rad_s);
}

/// Returns Sun and field at one time with the body at rest in the reference frame.
CarriedDirections both(double t_s) {
  CarriedDirections carried;
  add(carried, SampleKind::Sun, at_s(t_s), seen(Quaterniond::Identity(), kSun));
  add(carried, SampleKind::Magnetometer, at_s(t_s), seen(Quaterniond::Identity(), kField));
  return carried;
}

bool is_unobservable(const CarriedDirections& carried) {
  const auto attitude = carried.attitude();
  return !attitude && attitude.error().code == ErrorCode::Unobservable;
}

TEST(CarriedDirections, OfFewerThanTwoThereIsNoAttitude) {
  CarriedDirections carried;
  EXPECT_TRUE(is_unobservable(carried));
  add(carried, SampleKind::Sun, at_s(0.0), seen(Quaterniond::Identity(), kSun));
  EXPECT_TRUE(is_unobservable(carried));
  // A new direction of the same sensor replaces the old one.
  add(carried, SampleKind::Sun, at_s(0.1), seen(Quaterniond::Identity(), kField));
  EXPECT_TRUE(is_unobservable(carried));
  add(carried, SampleKind::Magnetometer, at_s(0.1), seen(Quaterniond::Identity(), kSun));
  EXPECT_TRUE(carried.attitude());
  carried.forget();
  EXPECT_TRUE(is_unobservable(carried));
}

TEST(CarriedDirections, OfTwoInLineThereIsNone) {
  for (const double sign : {-1.0, 1.0}) {
    CarriedDirections carried;
    add(carried, SampleKind::Sun, at_s(0.0), seen(Quaterniond::Identity(), kSun));
    add(carried, SampleKind::Magnetometer, at_s(0.0),
        seen(Quaterniond::Identity(), sign * kSun + 1e-4 * kField));
    EXPECT_TRUE(is_unobservable(carried));
  }
}

TEST(CarriedDirections, SeenAtDifferentTimesTheyGiveTheAttitudeOfNow) {
  std::mt19937_64 rng{1};
  for (int trial = 0; trial < 50; ++trial) {
    Quaterniond q_ref_body = any_attitude(rng);
    const Vector3d rate_rad_s = normal_vector(rng, 0.5);
    const Vector3d sun = normal_vector(rng, 1.0).normalized();
    const Vector3d field = normal_vector(rng, 1.0);
    CarriedDirections carried;
    for (int i = 1; i <= 30; ++i) {
      // The rotation is about the body's own axes.
      const Vector3d turned_rad = 0.1 * rate_rad_s + normal_vector(rng, 0.01);
      q_ref_body =
          q_ref_body * Quaterniond{Eigen::AngleAxisd{turned_rad.norm(), turned_rad.normalized()}};
      carried.turn(at_s(0.1 * i), turned_rad, {});
      if (i == 5) {
        add(carried, SampleKind::Magnetometer, at_s(0.1 * i), seen(q_ref_body, field));
      } else if (i == 20) {
        add(carried, SampleKind::Sun, at_s(0.1 * i), seen(q_ref_body, sun));
      }
    }
    const auto attitude = carried.attitude();
    if (std::abs(sun.cross(field.normalized()).norm()) > 0.05) {
      ASSERT_TRUE(attitude) << attitude.error().message;
      EXPECT_LT(attitude->q_ref_body.angularDistance(q_ref_body), 1e-7);
    }
  }
}

/// Returns the covariance of two perpendicular directions: the rotation about each comes from the
/// other direction, the rotation about the third axis from both.
Matrix3d covariance_of_two(double sun_rad2, double field_rad2) {
  return Vector3d{field_rad2, sun_rad2, sun_rad2 * field_rad2 / (sun_rad2 + field_rad2)}
      .asDiagonal();
}

void expect_covariance(const CarriedDirections& carried, const Matrix3d& expected_rad2) {
  const Matrix3d found_rad2 = carried.attitude().value().covariance_rad2;
  EXPECT_LT((found_rad2 - expected_rad2).norm(), 1e-9 * expected_rad2.norm()) << found_rad2;
}

TEST(CarriedDirections, TheCovarianceIsThatOfTwoDirections) {
  constexpr double kOwn_rad2 = kSigma_rad * kSigma_rad;
  expect_covariance(both(0.0), covariance_of_two(kOwn_rad2, kOwn_rad2));
}

TEST(CarriedDirections, WhatCarryingAddsIsOfThoseThatWereCarried) {
  constexpr double kOwn_rad2 = kSigma_rad * kSigma_rad;
  constexpr double kNoise_rad2 = 4e-6;
  constexpr double kDrift_rad = 3e-3;
  CarriedDirections carried = both(0.0);
  carried.turn(at_s(0.1), Vector3d::Zero(), {.noise_rad2 = kNoise_rad2, .drift_rad = kDrift_rad});
  const double once_rad2 = kOwn_rad2 + kNoise_rad2 + kDrift_rad * kDrift_rad;
  expect_covariance(carried, covariance_of_two(once_rad2, once_rad2));
  // The noise of two steps adds as variance, the drift of the bias as angle.
  add(carried, SampleKind::Sun, at_s(0.1), seen(Quaterniond::Identity(), kSun));
  carried.turn(at_s(0.2), Vector3d::Zero(), {.noise_rad2 = kNoise_rad2, .drift_rad = kDrift_rad});
  const double twice_rad2 = kOwn_rad2 + 2.0 * kNoise_rad2 + 4.0 * kDrift_rad * kDrift_rad;
  expect_covariance(carried, covariance_of_two(once_rad2, twice_rad2));
}

TEST(CarriedDirections, AfterFiveSecondsADirectionIsForgotten) {
  CarriedDirections carried = both(10.0);
  carried.turn(at_s(15.0), Vector3d::Zero(), {});
  EXPECT_TRUE(carried.attitude());
  add(carried, SampleKind::Sun, at_s(15.0), seen(Quaterniond::Identity(), kSun));
  carried.turn(at_s(15.1), Vector3d::Zero(), {});
  EXPECT_TRUE(is_unobservable(carried));
  // The Sun is still valid.
  add(carried, SampleKind::Magnetometer, at_s(15.1), seen(Quaterniond::Identity(), kField));
  EXPECT_TRUE(carried.attitude());
}

TEST(CarriedDirections, MayBeForgottenSooner) {
  CarriedDirections carried = both(10.0);
  carried.turn(at_s(11.0), Vector3d::Zero(), {}, 1.0);
  EXPECT_TRUE(carried.attitude());
  carried.turn(at_s(11.1), Vector3d::Zero(), {}, 1.0);
  EXPECT_TRUE(is_unobservable(carried));
}

/// The attitude that fits two directions of equal sigma shares the error of the angle between them
/// equally, with a chi-square of off^2 / (2 sigma^2) of one degree of freedom.
TEST(CarriedDirections, ContradictEachOtherWhereTheirAngleIsOffByMoreThanNoise) {
  const auto off_by = [](double sigmas, double carried_rad2) {
    CarriedDirections carried;
    const double off_rad =
        sigmas * std::numbers::sqrt2 * std::sqrt(kSigma_rad * kSigma_rad + carried_rad2);
    add(carried, SampleKind::Sun, at_s(0.0), seen(Quaterniond::Identity(), kSun));
    add(carried, SampleKind::Magnetometer, at_s(0.0),
        {.body = quaternion_by(off_rad * Vector3d::UnitZ()) * kField,
         .ref = kField,
         .sigma_rad = kSigma_rad});
    carried.turn(at_s(0.1), Vector3d::Zero(), {.noise_rad2 = carried_rad2, .drift_rad = 0.0});
    return carried;
  };
  for (const double carried_rad2 : {0.0, 1e-5}) {
    EXPECT_TRUE(off_by(4.95, carried_rad2).attitude());
    EXPECT_TRUE(is_unobservable(off_by(5.05, carried_rad2)));
    EXPECT_TRUE(is_unobservable(off_by(-5.05, carried_rad2)));
  }
}

/// The turn about the Sun comes from the field, that about the field from the Sun, the third from
/// both alike.
TEST(CarriedDirections, EachErrorTurnsTheAttitudeAsMuchAsItsDirectionCounts) {
  const TurnPerError per_error = both(0.0).attitude().value().per_error;
  TurnPerError expected = TurnPerError::Zero();
  expected.middleCols<3>(SunSensorError) = Vector3d{0.0, 1.0, 0.5}.asDiagonal();
  expected.middleCols<3>(MagnetometerError) = Vector3d{1.0, 0.0, 0.5}.asDiagonal();
  // Here the field is one nT strong.
  expected.middleCols<3>(MagnetometerBiasError) =
      expected.middleCols<3>(MagnetometerError) * cross_matrix(kField);
  EXPECT_LT((per_error - expected).norm(), 1e-12);
}

TEST(CarriedDirections, LateStampsAndGyroErrorsTurnWhatIsCarried) {
  const Vector3d rate_rad_s{0.0, 0.0, 0.1};
  CarriedDirections carried;
  add(carried, SampleKind::Sun, at_s(0.0), seen(Quaterniond::Identity(), kSun), rate_rad_s);
  carried.turn(at_s(2.0), 2.0 * rate_rad_s, {});
  const Quaterniond turned = quaternion_by(2.0 * rate_rad_s);
  add(carried, SampleKind::Magnetometer, at_s(2.0), seen(turned, kField), rate_rad_s);
  const TurnPerError per_error = carried.attitude().value().per_error;
  // Half of what the Sun says of the turn about z.
  EXPECT_LT((per_error.col(SunSensorTimeError) - 0.5 * rate_rad_s).norm(), 1e-12);
  EXPECT_LT((per_error.col(MagnetometerTimeError) - 0.5 * rate_rad_s).norm(), 1e-12);
  EXPECT_LT((per_error.col(GyroScaleError + 2) + 0.5 * 2.0 * rate_rad_s).norm(), 1e-12);
}

TEST(CarriedDirections, ADifferenceThatTheAlignmentExplainsIsNoContradiction) {
  for (const double mounting_rad : {0.0, 3e-3}) {
    FilterAlignment alignment = FilterAlignment::Zero();
    alignment.diagonal().segment<3>(SunSensorError).setConstant(mounting_rad * mounting_rad);
    const double expected_rad =
        std::sqrt(2.0 * kSigma_rad * kSigma_rad + mounting_rad * mounting_rad);
    const auto off_by = [&](double sigmas) {
      CarriedDirections carried{alignment};
      add(carried, SampleKind::Sun, at_s(0.0), seen(Quaterniond::Identity(), kSun));
      add(carried, SampleKind::Magnetometer, at_s(0.0),
          {.body = quaternion_by(sigmas * expected_rad * Vector3d::UnitZ()) * kField,
           .ref = kField,
           .sigma_rad = kSigma_rad});
      return carried;
    };
    EXPECT_TRUE(off_by(4.95).attitude()) << mounting_rad;
    EXPECT_TRUE(is_unobservable(off_by(5.05))) << mounting_rad;
  }
}

}  // namespace spindrift::testing::carried_directions_test
