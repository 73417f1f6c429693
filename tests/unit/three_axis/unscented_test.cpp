/// Closed cases of the unscented filters.

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "pipelines/frames/angle.h"
#include "pipelines/ground_model/dynamics/disturbances.h"
#include "pipelines/three_axis/mekf.h"
#include "pipelines/three_axis/unscented/gukf_bank.h"
#include "pipelines/three_axis/unscented/usque.h"
#include "tests/support/turning_body.h"

namespace spindrift::testing::unscented_test {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

using Scalar = Eigen::Matrix<double, 1, 1>;

TEST(StatisticalLinearisation, IsExactForALine) {
  Matrix3d covariance;
  covariance << 4.0, 1.0, 0.0, 1.0, 2.0, 0.5, 0.0, 0.5, 1.0;
  const Eigen::Matrix<double, 2, 3> slope{{1.0, -2.0, 3.0}, {0.5, 0.0, -1.0}};
  const auto result = linearised<2, 3>(
      covariance, [&](const Vector3d& away) -> Eigen::Vector2d { return slope * away; });
  EXPECT_LT((result.slope - slope).norm(), 1e-12);
  EXPECT_LT(result.shift.norm(), 1e-12);
  EXPECT_LT(result.curved.norm(), 1e-12);
}

TEST(StatisticalLinearisation, HasMeanAndVarianceOfASquare) {
  const auto result = linearised<1, 1>(Scalar{0.25}, [](const Scalar& away) -> Scalar {
    return Scalar{(2.0 + away[0]) * (2.0 + away[0]) - 4.0};
  });
  EXPECT_NEAR(result.shift[0], 0.25, 1e-12);
  EXPECT_NEAR(result.slope(0, 0), 4.0, 1e-12);
  EXPECT_NEAR(result.curved(0, 0), 2.0 * 0.25 * 0.25, 1e-12);
}

TEST(StatisticalLinearisation, LeavesOutWhatIsKnown) {
  Matrix3d covariance = Matrix3d::Zero();
  covariance(0, 0) = 1.0;
  int calls = 0;
  const auto result = linearised<1, 3>(covariance, [&](const Vector3d& away) -> Scalar {
    ++calls;
    return Scalar{away.sum()};
  });
  EXPECT_EQ(calls, 2);
  EXPECT_NEAR(result.slope(0, 0), 1.0, 1e-12);
  EXPECT_EQ(result.slope(0, 1), 0.0);
}

TEST(Rodrigues, AreTheTurn) {
  std::mt19937_64 rng{71};
  for (int i = 0; i < 20; ++i) {
    const Quaterniond q = any_attitude(rng);
    EXPECT_LT(angle_between_rad(quaternion_of_rodrigues(rodrigues_of(q)), q), 1e-12);
    EXPECT_LE(rodrigues_of(q).norm(), 4.0);
  }
  const Vector3d small_rad{1e-4, -2e-4, 3e-4};
  EXPECT_LT((rodrigues_of(quaternion_by(small_rad)) - small_rad).norm(), 1e-11);
}

UncertainAttitude known_to(const Quaterniond& q, double sigma_rad) {
  return {.q_ref_body = q, .covariance_rad2 = sigma_rad * sigma_rad * Matrix3d::Identity()};
}

UncertainMotion moving(const BodyState& motion, double turn_rad, double rate_rad_s) {
  UncertainMotion start{.motion = motion, .covariance = Eigen::Matrix<double, 6, 6>::Zero()};
  start.covariance.topLeftCorner<3, 3>() = turn_rad * turn_rad * Matrix3d::Identity();
  start.covariance.bottomRightCorner<3, 3>() = rate_rad_s * rate_rad_s * Matrix3d::Identity();
  return start;
}

TEST(Usque, IsTheExtendedFilterWhereErrorsAreSmall) {
  std::mt19937_64 rng{72};
  const UncertainAttitude start = known_to(any_attitude(rng), 1e-3);
  constexpr double kBiasSigma_rad_s = 1e-5;
  Usque usque{start, kBiasSigma_rad_s};
  Mekf mekf{SensitiveAttitude{start}, kBiasSigma_rad_s};
  const Vector3d sun_icrf = Vector3d{1.0, 2.0, -0.5}.normalized();
  for (int step = 0; step < 50; ++step) {
    const RateSpan span{.dt_s = 1.0,
                        .from_rad_s = {0.01, 0.02, -0.01},
                        .to_rad_s = Vector3d{0.01, 0.02, -0.01} + normal_vector(rng, 1e-4)};
    const SpanErrors errors{.turn_rad2 = 1e-10, .bias_rad2_s2 = 1e-16};
    usque.propagate(span, errors);
    mekf.propagate(span, errors);
    const Vector3d sun_body =
        (mekf.q_icrf_body().conjugate() * sun_icrf + normal_vector(rng, 1e-3)).normalized();
    const SeenSun sun{.body = sun_body, .ref_icrf = sun_icrf, .sigma_rad = 1e-3};
    const SeenDirection direction{
        .t = at_s(0.0), .kind = SampleKind::Sun, .direction = {sun_body, sun_icrf, 1e-3}};
    const UnscentedInnovation innovation = usque.innovation(sun);
    const Mekf::Innovation expected = mekf.innovation(direction);
    EXPECT_LT((innovation.residual.value - expected.residual.value).norm(), 1e-5);
    EXPECT_LT((innovation.residual.sigma - expected.residual.sigma).norm(), 1e-5);
    EXPECT_NEAR(innovation.nis, expected.nis, 0.02 * (1.0 + expected.nis));
    usque.update(sun);
    mekf.update(direction);
    if (step % 10 == 5) {
      const Quaterniond stars = mekf.q_icrf_body() * quaternion_by(normal_vector(rng, 1e-4));
      usque.update(SeenStars{.q_icrf_body = stars, .sigma_rad = 1e-4});
      mekf.update(ObservedAttitude{stars, 1e-4});
    }
  }
  EXPECT_LT(angle_between_rad(usque.q_icrf_body(), mekf.q_icrf_body()), 1e-6);
  EXPECT_LT((usque.bias_rad_s() - mekf.bias_rad_s()).norm(), 1e-8);
  EXPECT_LT((usque.covariance() - mekf.covariance()).norm() / mekf.covariance().norm(), 1e-3);
}

/// Moments and axes that are not the body's, wheels and torques.
TEST(Gukf, MovesAsTheRigidBody) {
  std::mt19937_64 rng{73};
  const Matrix3d axes = any_attitude(rng).toRotationMatrix();
  const Matrix3d inertia = axes * Vector3d{1.0, 1.5, 2.0}.asDiagonal() * axes.transpose();
  const RigidBody body = RigidBody::make(0.5 * (inertia + inertia.transpose())).value();
  BodyTorques torques{.external_nm = {1e-3, -2e-3, 1e-3},
                      .wheels_nm = {1e-4, 0.0, -1e-4},
                      .wheels_nms = {0.01, 0.02, -0.01}};
  BodyState truth{any_attitude(rng), {0.02, -0.01, 0.03}};
  Gukf filter{GukfModel{.inertia_kg_m2 = body.inertia_kg_m2()}, moving(truth, 1e-7, 1e-9)};
  filter.propagate(10.0, torques);
  for (int step = 0; step < 1000; ++step) {
    truth = body.after(truth, torques, 0.01);
    torques.wheels_nms -= 0.01 * torques.wheels_nm;
  }
  EXPECT_LT(angle_between_rad(filter.q_icrf_body(), truth.q_icrf_body), 1e-5);
  EXPECT_LT((filter.rate_rad_s() - truth.rate_body_rad_s).norm(), 1e-7);
}

TEST(Gukf, IsTurnedByTheEarthsGravity) {
  const Matrix3d inertia = Vector3d{1.0, 1.5, 2.0}.asDiagonal();
  const RigidBody body = RigidBody::make(inertia).value();
  const Vector3d position_icrf_km{5000.0, 3000.0, 4000.0};
  BodyState truth{Quaterniond::Identity(), {1e-4, -2e-4, 1e-4}};
  Gukf filter{GukfModel{.inertia_kg_m2 = inertia}, moving(truth, 1e-7, 1e-9)};
  for (int minute = 0; minute < 10; ++minute) {
    filter.propagate(60.0, {}, position_icrf_km);
  }
  for (int second = 0; second < 600; ++second) {
    const Vector3d place_body_km = truth.q_icrf_body.conjugate() * position_icrf_km;
    truth = body.after(truth, {.external_nm = gravity_gradient_nm(inertia, place_body_km)}, 1.0);
  }
  EXPECT_GT((truth.rate_body_rad_s - Vector3d{1e-4, -2e-4, 1e-4}).norm(), 1e-4);
  EXPECT_LT((filter.rate_rad_s() - truth.rate_body_rad_s).norm(), 1e-6);
}

TEST(MotionBetween, IsConsistentOverManyPairs) {
  std::mt19937_64 rng{76};
  constexpr double kSigma_rad = 0.01;
  constexpr double kApart_s = 10.0;
  constexpr int kPairs = 500;
  double nees = 0.0;
  for (int pair = 0; pair < kPairs; ++pair) {
    const Vector3d rate_rad_s = normal_vector(rng, 0.005);
    const Quaterniond first = any_attitude(rng);
    const Quaterniond second = first * quaternion_by(kApart_s * rate_rad_s);
    const auto seen = [&](const Quaterniond& q) {
      return known_to(q * quaternion_by(normal_vector(rng, kSigma_rad)), kSigma_rad);
    };
    const UncertainMotion motion = motion_between(seen(first), seen(second), kApart_s);
    Eigen::Matrix<double, 6, 1> error;
    error << error_rad(motion.motion.q_icrf_body, second),
        rate_rad_s - motion.motion.rate_body_rad_s;
    nees += error.dot(motion.covariance.ldlt().solve(error));
  }
  // A rate that changes is allowed for, and does not.
  EXPECT_LT(nees / kPairs, 6.2);
  EXPECT_GT(nees / kPairs, 4.5);
}

constexpr double kField_nt = 30'000.0;

TEST(Gukf, KnowsNothingOfTheTurnAboutASingleVector) {
  std::mt19937_64 rng{74};
  const double sigma_rad = 20.0 * kRadPerDeg;
  const BodyState start{any_attitude(rng), Vector3d::Zero()};
  const Vector3d ref_icrf_nt = kField_nt * normal_vector(rng, 1.0).normalized();
  const Vector3d body_nt = start.q_icrf_body.conjugate() * ref_icrf_nt;
  Gukf filter{GukfModel{.inertia_kg_m2 = Matrix3d::Identity()}, moving(start, sigma_rad, 1e-3)};
  // The measured direction is 30 deg off the expected one.
  const Vector3d off_nt = quaternion_by(30.0 * kRadPerDeg * body_nt.unitOrthogonal()) * body_nt;
  for (int i = 0; i < 20; ++i) {
    filter.update(SeenField{.body_nt = off_nt, .ref_icrf_nt = ref_icrf_nt, .noise_nt = 100.0});
  }
  const Vector3d along = off_nt.normalized();
  const Vector3d across = along.unitOrthogonal();
  const Matrix3d covariance = filter.attitude_covariance_rad2();
  EXPECT_NEAR(std::sqrt(along.dot(covariance * along)), sigma_rad, 0.05 * sigma_rad);
  EXPECT_LT(std::sqrt(across.dot(covariance * across)), 1e-3);
}

TEST(Gukf, AnInnovationContainsTheMissionFilesErrors) {
  GukfModel model{.inertia_kg_m2 = Matrix3d::Identity()};
  model.alignment.diagonal().segment<3>(MagnetometerError).setConstant(0.005 * 0.005);
  model.alignment.diagonal().segment<3>(MagnetometerBiasError).setConstant(70.0 * 70.0);
  const BodyState start{Quaterniond::Identity(), Vector3d::Zero()};
  const SeenField field{
      .body_nt = {100.0, 0.0, kField_nt}, .ref_icrf_nt = {0.0, 0.0, kField_nt}, .noise_nt = 100.0};
  Gukf filter{model, moving(start, 1e-9, 1e-9)};
  const UnscentedInnovation innovation = filter.innovation(field);
  const double across_nt = std::sqrt(100.0 * 100.0 + 70.0 * 70.0 + 150.0 * 150.0);
  EXPECT_EQ(innovation.residual.freedom, 3);
  EXPECT_NEAR(innovation.residual.value[0], 100.0, 1e-6);
  EXPECT_NEAR(innovation.residual.sigma[0], across_nt, 0.01);
  EXPECT_NEAR(innovation.residual.sigma[2], std::hypot(100.0, 70.0), 0.01);
  EXPECT_NEAR(innovation.nis, std::pow(100.0 / across_nt, 2), 1e-4);

  // Of a known attitude, noise is what the mounting leaves of sigma.
  Gukf wide{model, moving(start, 0.1, 1e-9)};
  for (int i = 0; i < 10'000; ++i) {
    wide.update(SeenField{
        .body_nt = field.ref_icrf_nt, .ref_icrf_nt = field.ref_icrf_nt, .noise_nt = 10.0});
  }
  const double mounting_and_bias_rad = std::hypot(0.005, 70.0 / kField_nt);
  EXPECT_NEAR(std::sqrt(wide.attitude_covariance_rad2()(0, 0)), mounting_and_bias_rad, 2e-4);
  EXPECT_LT(std::sqrt(wide.attitude_noise_rad2()(0, 0)), 1e-4);
}

/// A time tag that is too late stands for the field of a moment before.
TEST(Gukf, ATimeTagTurnsTheFieldWithTheRate) {
  GukfModel model{.inertia_kg_m2 = Matrix3d::Identity()};
  model.alignment(MagnetometerTimeError, MagnetometerTimeError) = 0.5 * 0.5;
  const BodyState start{Quaterniond::Identity(), {0.0, 0.02, 0.0}};
  const Gukf filter{model, moving(start, 1e-9, 1e-9)};
  const Vector3d sigma_nt = filter
                                .innovation(SeenField{.body_nt = {0.0, 0.0, kField_nt},
                                                      .ref_icrf_nt = {0.0, 0.0, kField_nt},
                                                      .noise_nt = 1.0})
                                .residual.sigma;
  EXPECT_NEAR(sigma_nt[0], 0.5 * 0.02 * kField_nt, 0.1);
  EXPECT_NEAR(sigma_nt[1], 1.0, 0.01);
}

TEST(GukfBank, StartsWithTheRateOfTheFieldAndAttitudesAboutIt) {
  std::mt19937_64 rng{75};
  const Quaterniond q = any_attitude(rng);
  const Vector3d ref_icrf_nt = kField_nt * normal_vector(rng, 1.0).normalized();
  const Vector3d rate_rad_s = 0.02 * (q.conjugate() * ref_icrf_nt).unitOrthogonal();
  const double dt_s = 5.0;
  const auto seen = [&](double t_s) {
    return SeenField{.body_nt = (q * quaternion_by(t_s * rate_rad_s)).conjugate() * ref_icrf_nt,
                     .ref_icrf_nt = ref_icrf_nt,
                     .noise_nt = 100.0};
  };
  const GukfBank bank{GukfModel{.inertia_kg_m2 = Matrix3d::Identity()}, seen(0.0), seen(dt_s),
                      dt_s};
  EXPECT_EQ(bank.size(), 8U);
  EXPECT_LT((bank.best().rate_rad_s() - rate_rad_s).norm(), 1e-9);
  const Vector3d expected_nt = bank.best().q_icrf_body().conjugate() * ref_icrf_nt;
  EXPECT_LT((expected_nt - seen(dt_s).body_nt).norm(), 1e-6);
  EXPECT_EQ(bank.lead_nats(), 0.0);
}

TEST(GukfBank, KnownMotionHasNoRival) {
  const GukfBank bank{GukfModel{.inertia_kg_m2 = Matrix3d::Identity()},
                      moving({Quaterniond::Identity(), Vector3d::Zero()}, 0.01, 1e-4)};
  EXPECT_EQ(bank.size(), 1U);
  EXPECT_EQ(bank.lead_nats(), std::numeric_limits<double>::infinity());
  EXPECT_TRUE(bank.is_settled());
}

/// A body at rest cannot see a field that turns.
TEST(GukfBank, StartsAgainWhereItIsContradicted) {
  GukfBank bank{GukfModel{.inertia_kg_m2 = Matrix3d::Identity(), .torque_noise_nm_rts = 1e-9},
                moving({Quaterniond::Identity(), Vector3d::Zero()}, 1e-3, 1e-6)};
  bool is_contradicted = false;
  for (int step = 0; step < 30 && bank.size() == 1; ++step) {
    bank.propagate(10.0);
    is_contradicted = bank.is_contradicted();
    bank.update(SeenField{.body_nt = kField_nt * Vector3d{std::cos(step), std::sin(step), 0.0},
                          .ref_icrf_nt = {kField_nt, 0.0, 0.0},
                          .noise_nt = 100.0});
  }
  EXPECT_TRUE(is_contradicted || bank.size() == 8U);
  EXPECT_EQ(bank.size(), 8U);
}

}  // namespace spindrift::testing::unscented_test
