#include "pipelines/three_axis/mekf.h"

#include <Eigen/Dense>
#include <cmath>
#include <random>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/rotation_vector.h"
#include "tests/support/matchers.h"
#include "tests/support/turning_body.h"

namespace spindrift::testing::mekf_test {

using Eigen::Matrix3d;
using Eigen::Vector3d;

SensitiveAttitude known_to(const Eigen::Quaterniond& q, double sigma_rad) {
  return {{.q_ref_body = q, .covariance_rad2 = sigma_rad * sigma_rad * Matrix3d::Identity()}};
}

SeenDirection seen(SampleKind kind, const Vector3d& body, const Vector3d& ref, double sigma_rad) {
  return {.t = at_s(0.0), .kind = kind, .direction = {body, ref, sigma_rad}};
}

TEST(TurnOfAnEvenlyChangingRate, IsTheIntegralOfTheBody) {
  const Vector3d from_rad_s{0.02, -0.03, 0.01};
  const Vector3d to_rad_s{-0.01, 0.02, 0.04};
  const Vector3d bias_rad_s{0.001, 0.002, -0.003};
  const RateSpan span{.dt_s = 2.0, .from_rad_s = from_rad_s, .to_rad_s = to_rad_s};
  const TurningBody body{Eigen::Quaterniond::Identity(), 2.0, [&](double t_s) {
                           return from_rad_s + 0.5 * t_s * (to_rad_s - from_rad_s) - bias_rad_s;
                         }};
  const Eigen::Quaterniond turned = quaternion_by(turned_rad(span, bias_rad_s));
  EXPECT_LT(angle_between_rad(turned, body.q_icrf_body(2.0)), 5e-6);
  // The mean rate alone is much less accurate.
  EXPECT_GT(angle_between_rad(quaternion_by(from_rad_s + to_rad_s - 2.0 * bias_rad_s),
                              body.q_icrf_body(2.0)),
            1e-4);
}

/// The expected slopes are finite differences of the propagation.
TEST(Mekf, CovarianceMovesAsTheErrorDoes) {
  std::mt19937_64 rng{61};
  const RateSpan span{
      .dt_s = 3.0, .from_rad_s = normal_vector(rng, 0.3), .to_rad_s = normal_vector(rng, 0.3)};
  const Eigen::Quaterniond q = any_attitude(rng);
  Mekf filter{known_to(q, 0.02), 0.001};
  // A measurement correlates rotation and bias.
  filter.propagate(span, {.turn_rad2 = 0.0, .bias_rad2_s2 = 0.0});
  filter.update(ObservedAttitude{filter.q_icrf_body(), 1e-4});
  const Mekf::Covariance before = filter.covariance();
  const Eigen::Quaterniond q_before = filter.q_icrf_body();
  const Vector3d bias = filter.bias_rad_s();
  const Eigen::Quaterniond q_after = q_before * quaternion_by(turned_rad(span, bias));
  constexpr double kStep = 1e-6;
  Mekf::Covariance slope = Mekf::Covariance::Identity();
  for (int i = 0; i < 3; ++i) {
    const Vector3d step = kStep * Vector3d::Unit(i);
    slope.block<3, 1>(0, i) =
        error_rad(q_after, q_before * quaternion_by(step) * quaternion_by(turned_rad(span, bias))) /
        kStep;
    // The slope neglects the Magnus term, which is small for spans between samples.
    RateSpan mean = span;
    mean.from_rad_s = mean.to_rad_s = turned_rad(span, bias) / span.dt_s + bias;
    slope.block<3, 1>(0, 3 + i) =
        error_rad(q_after, q_before * quaternion_by(turned_rad(mean, bias + step))) / kStep;
  }
  filter.propagate(span, {.turn_rad2 = 3e-6, .bias_rad2_s2 = 5e-9});
  Mekf::Covariance expected = slope * before * slope.transpose();
  expected.topLeftCorner<3, 3>() += 3e-6 * Matrix3d::Identity();
  expected.bottomRightCorner<3, 3>() += 5e-9 * Matrix3d::Identity();
  EXPECT_NEAR((filter.covariance() - expected).cwiseAbs().maxCoeff(), 0.0,
              1e-5 * expected.cwiseAbs().maxCoeff());
  EXPECT_NEAR(angle_between_rad(filter.q_icrf_body(), q_after), 0.0, 1e-12);
}

TEST(Mekf, AFixIsWeighedAgainstWhatWasKnown) {
  const Eigen::Quaterniond truth{Eigen::AngleAxisd{1.0, Vector3d::UnitY()}};
  Mekf filter{known_to(truth, 0.003), 0.001};
  const Vector3d off_rad{0.004, 0.0, -0.001};
  const ObservedAttitude fix{truth * quaternion_by(off_rad), 0.001};
  EXPECT_NEAR(filter.innovation(fix).nis, off_rad.squaredNorm() / 1e-5, 1e-9);
  filter.update(fix);
  EXPECT_NEAR((error_rad(truth, filter.q_icrf_body()) - 0.9 * off_rad).norm(), 0.0, 1e-8);
  EXPECT_NEAR((filter.attitude_covariance_rad2() - 9e-7 * Matrix3d::Identity()).norm(), 0.0, 1e-11);
  EXPECT_EQ(filter.bias_rad_s(), Vector3d::Zero());
}

/// A filter that began at a star fix has the error of the tracker's mounting.
TEST(Mekf, AnInnovationIsExpectedWithTheAlignmentOfBothSensors) {
  constexpr double kStar_rad = 0.002;
  constexpr double kSun_rad = 0.003;
  constexpr double kField_rad = 0.004;
  constexpr double kBias_nt = 50.0;
  constexpr double kNoise_rad = 0.001;
  FilterAlignment alignment = FilterAlignment::Zero();
  alignment.diagonal().segment<3>(StarTrackerError).setConstant(kStar_rad * kStar_rad);
  alignment.diagonal().segment<3>(SunSensorError).setConstant(kSun_rad * kSun_rad);
  alignment.diagonal().segment<3>(MagnetometerError).setConstant(kField_rad * kField_rad);
  alignment.diagonal().segment<3>(MagnetometerBiasError).setConstant(kBias_nt * kBias_nt);
  SensitiveAttitude begin = known_to(Eigen::Quaterniond::Identity(), 0.0005);
  begin.per_error = -star_per_error(Vector3d::Zero());
  const Mekf filter{begin, 0.001, alignment};
  const double known_rad2 = 0.0005 * 0.0005 + kStar_rad * kStar_rad + kNoise_rad * kNoise_rad;

  const Residual sun =
      filter.innovation(seen(SampleKind::Sun, Vector3d::UnitX(), Vector3d::UnitX(), kNoise_rad))
          .residual;
  EXPECT_NEAR(sun.sigma[0], std::sqrt(known_rad2 + kSun_rad * kSun_rad), 1e-12);
  EXPECT_NEAR(sun.sigma[1], sun.sigma[0], 1e-12);

  const Vector3d field_nt{0.0, 0.0, 20'000.0};
  SeenDirection strong = seen(SampleKind::Magnetometer, field_nt, field_nt, kNoise_rad);
  strong.stronger = 2.0;
  const Residual field = filter.innovation(strong).residual;
  const double bias_rad2 = std::pow(kBias_nt / 20'000.0, 2);
  EXPECT_NEAR(field.sigma[0], std::sqrt(known_rad2 + kField_rad * kField_rad + bias_rad2), 1e-12);
  EXPECT_NEAR(field.sigma[2], std::sqrt(kNoise_rad * kNoise_rad + bias_rad2), 1e-12);
  EXPECT_NEAR(field.value[2], 2.0 * kNoise_rad, 1e-12);

  // A fix of the same tracker has the same error.
  const Residual star =
      filter.innovation(ObservedAttitude{Eigen::Quaterniond::Identity(), kNoise_rad}).residual;
  EXPECT_NEAR(star.sigma[0], std::hypot(0.0005, kNoise_rad), 1e-12);
}

TEST(Mekf, EitherSignOfTheQuaternionIsTheSameFix) {
  std::mt19937_64 rng{62};
  for (int trial = 0; trial < 100; ++trial) {
    const Eigen::Quaterniond truth = any_attitude(rng);
    const Eigen::Quaterniond measured = truth * quaternion_by(normal_vector(rng, 0.01));
    Mekf one{known_to(truth, 0.02), 0.001};
    Mekf other = one;
    const ObservedAttitude fix{measured, 0.01};
    const ObservedAttitude flipped{Eigen::Quaterniond{-measured.coeffs()}, 0.01};
    ASSERT_EQ(one.innovation(fix).nis, other.innovation(flipped).nis);
    one.update(fix);
    other.update(flipped);
    ASSERT_EQ(one.q_icrf_body().coeffs(), other.q_icrf_body().coeffs());
  }
}

TEST(Mekf, ADirectionSaysNothingOfTheTurnAboutIt) {
  std::mt19937_64 rng{63};
  for (int trial = 0; trial < 200; ++trial) {
    const Eigen::Quaterniond truth = any_attitude(rng);
    const Vector3d ref = normal_vector(rng, 1.0).normalized();
    const Vector3d body = truth.conjugate() * ref;
    // The initial error is large, so the correction is too.
    const double sigma_rad = 10.0 * kRadPerDeg;
    Mekf filter{known_to(truth * quaternion_by(normal_vector(rng, sigma_rad)), sigma_rad), 0.001};
    for (int repeated = 0; repeated < 50; ++repeated) {
      filter.update(seen(SampleKind::Sun, body, ref, 0.002));
    }
    const Matrix3d covariance = filter.attitude_covariance_rad2();
    ASSERT_NEAR(std::sqrt(body.dot(covariance * body)), sigma_rad, 0.03 * sigma_rad);
    ASSERT_LT(std::sqrt(covariance.trace() - body.dot(covariance * body)), 0.0005);
    // The prior still has an effect: five of its sigmas times the ratio of the variances.
    ASSERT_NEAR((filter.q_icrf_body().conjugate() * ref - body).norm(), 0.0,
                5.0 * (0.002 * 0.002 / 50.0) / sigma_rad);
  }
}

/// The noise of a direction must not seem to measure a bias of the field along itself.
TEST(Mekf, TheDirectionOfAFieldSaysNothingOfABiasAlongIt) {
  std::mt19937_64 rng{64};
  Mekf filter{known_to(Eigen::Quaterniond::Identity(), 1e-5), 1e-9};
  const Vector3d field_nt{0.0, 0.0, 20'000.0};
  for (int i = 0; i < 200; ++i) {
    const Vector3d measured_nt = field_nt + normal_vector(rng, 200.0);
    filter.update(seen(SampleKind::Magnetometer, measured_nt, field_nt, 0.01));
  }
  const auto of_bias = filter.evidence().information().diagonal().segment<3>(MagnetometerBiasError);
  EXPECT_NEAR(of_bias[0], 200.0 / (200.0 * 200.0), 0.01 * of_bias[0]);
  EXPECT_LT(of_bias[2], 1e-6 * of_bias[0]);
}

TEST(Mekf, CovarianceStaysPositiveThroughSharpFixes) {
  Mekf filter{known_to(Eigen::Quaterniond::Identity(), 0.5), 0.01};
  const Vector3d rate_rad_s{0.0, 0.01, 0.0};
  for (int i = 0; i < 20000; ++i) {
    filter.propagate({.dt_s = 0.1, .from_rad_s = rate_rad_s, .to_rad_s = rate_rad_s},
                     {.turn_rad2 = 1e-16, .bias_rad2_s2 = 0.0});
    filter.update(ObservedAttitude{filter.q_icrf_body(), 1e-7});
  }
  const Eigen::SelfAdjointEigenSolver<Mekf::Covariance> solver{filter.covariance()};
  EXPECT_GT(solver.eigenvalues()[0], 0.0);
  EXPECT_NEAR((filter.covariance() - filter.covariance().transpose()).cwiseAbs().maxCoeff(), 0.0,
              1e-20);
}

}  // namespace spindrift::testing::mekf_test
