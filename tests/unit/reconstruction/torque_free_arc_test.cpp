#include "pipelines/reconstruction/torque_free_arc.h"

#include <Eigen/Eigenvalues>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/euler312.h"
#include "pipelines/frames/rotation_vector.h"
#include "tests/support/matchers.h"

namespace spindrift::torque_free_arc_test {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

const Matrix3d kInertia_kg_m2 = (Matrix3d{} << 120.0, 4.0, -3.0,  //
                                 4.0, 100.0, 2.0,                 //
                                 -3.0, 2.0, 140.0)
                                    .finished();
const BodyState kStart{Quaterniond{0.3, -0.5, 0.7, 0.4}.normalized(), Vector3d{0.3, -0.2, 0.4}};

ArcState arc_from(const BodyState& start, const std::optional<Matrix3d>& inertia_kg_m2,
                  double duration_s) {
  return torque_free_arc(start_of_arc(start), inertia_kg_m2, duration_s);
}

// Source: Li 2017, table 2.
TEST(TorqueFreeArc, LandsWhereTheFlightDidAtSeparation) {
  const Euler312 control_on{38.403 * kRadPerDeg, 88.224 * kRadPerDeg, 118.045 * kRadPerDeg};
  const Euler312 separation{31.011 * kRadPerDeg, 82.472 * kRadPerDeg, 162.749 * kRadPerDeg};
  const Vector3d rate_rad_s = Vector3d{0.618844, -0.33139, 0.065912} * kRadPerDeg;
  const ArcState at = arc_from({quaternion_of(control_on), rate_rad_s}, std::nullopt, -60.0);
  EXPECT_LT(degrees(angle_between_rad(at.body.q_icrf_body, quaternion_of(separation))), 0.1);
  const Euler312 angles = euler312_of(at.body.q_icrf_body).angles;
  EXPECT_NEAR(degrees(angles.phi_rad), 31.024, 0.001);
  EXPECT_NEAR(degrees(angles.theta_rad), 82.399, 0.001);
  EXPECT_NEAR(degrees(angles.psi_rad), 162.793, 0.001);
}

TEST(TorqueFreeArc, KeepsMomentumAndEnergyForwardsAndBackwards) {
  const auto momentum = [](const BodyState& body) -> Vector3d {
    return body.q_icrf_body * (kInertia_kg_m2 * body.rate_body_rad_s);
  };
  const auto energy = [](const BodyState& body) {
    return body.rate_body_rad_s.dot(kInertia_kg_m2 * body.rate_body_rad_s);
  };
  for (const double duration_s : {-200.0, -0.1, 0.0, 200.0}) {
    const BodyState end = arc_from(kStart, kInertia_kg_m2, duration_s).body;
    EXPECT_LT((momentum(end) - momentum(kStart)).norm(), 1e-8 * momentum(kStart).norm());
    EXPECT_NEAR(energy(end), energy(kStart), 1e-8 * energy(kStart));
    const BodyState back = arc_from(end, kInertia_kg_m2, -duration_s).body;
    EXPECT_LT(angle_between_rad(back.q_icrf_body, kStart.q_icrf_body), 1e-8);
  }
}

/// A body with two equal moments of inertia has a closed solution.
TEST(TorqueFreeArc, IsWithinItsStatedErrorOfTheClosedSolution) {
  constexpr double kTransverse = 100.0;
  constexpr double kAxial = 140.0;
  const Matrix3d inertia = Vector3d{kTransverse, kTransverse, kAxial}.asDiagonal();
  const Vector3d rate{0.05, 0.0, 0.3};
  constexpr double kDuration_s = -100.0;
  const Vector3d momentum = inertia * rate;
  const double precession_rad = momentum.norm() / kTransverse * kDuration_s;
  const double body_rad = (1.0 - kAxial / kTransverse) * rate.z() * kDuration_s;
  const Quaterniond expected = quaternion_by(precession_rad * momentum.normalized()) *
                               quaternion_by(body_rad * Vector3d::UnitZ());
  const ArcState at = arc_from({Quaterniond::Identity(), rate}, inertia, kDuration_s);
  EXPECT_LT(angle_between_rad(at.body.q_icrf_body, expected), 1e-9 * std::abs(precession_rad));
}

TEST(TorqueFreeArc, SlopesAreWhatSmallChangesOfTheStartBecome) {
  constexpr double kDuration_s = -60.0;
  constexpr double kStep = 1e-6;
  const ArcState at = arc_from(kStart, kInertia_kg_m2, kDuration_s);
  const auto difference = [&](const BodyState& a, const BodyState& b) {
    Eigen::Matrix<double, 6, 1> change;
    change << rotation_vector_of(a.q_icrf_body.conjugate() * b.q_icrf_body),
        b.rate_body_rad_s - a.rate_body_rad_s;
    return Eigen::Matrix<double, 6, 1>{change / (2.0 * kStep)};
  };
  const Eigen::SelfAdjointEigenSolver<Matrix3d> principal{kInertia_kg_m2};
  for (int i = 0; i < 9; ++i) {
    const auto moved = [&](double step) {
      BodyState start = kStart;
      Matrix3d inertia = kInertia_kg_m2;
      if (i < 3) {
        start.q_icrf_body = start.q_icrf_body * quaternion_by(step * Vector3d::Unit(i));
      } else if (i < 6) {
        start.rate_body_rad_s += step * Vector3d::Unit(i - 3);
      } else {
        const Vector3d axis = principal.eigenvectors().col(i - 6);
        inertia += step * principal.eigenvalues()[i - 6] * axis * axis.transpose();
      }
      return arc_from(start, inertia, kDuration_s).body;
    };
    const Eigen::Matrix<double, 6, 1> numeric = difference(moved(-kStep), moved(kStep));
    EXPECT_LT((at.slopes.col(i) - numeric).norm(), 1e-6 * (1.0 + numeric.norm())) << i;
  }
}

/// The body is slow, so that a constant acceleration in body axes is nearly constant in ICRF.
TEST(TorqueFreeArc, AnEvenDisturbanceGrowsWithTheSquareOfTheTime) {
  const ArcState at =
      arc_from({Quaterniond::Identity(), 1e-9 * Vector3d::UnitX()}, kInertia_kg_m2, -60.0);
  const Eigen::Matrix<double, 6, 6> covariance =
      covariance_of(at.slopes, {.start = Eigen::Matrix<double, 6, 6>::Zero(),
                                .inertia_fraction = 0.0,
                                .acceleration_rad_s2 = Vector3d::Constant(1e-6)});
  EXPECT_NEAR(std::sqrt(covariance(0, 0)), 0.5 * 1e-6 * 3600.0, 1e-9);
  EXPECT_NEAR(std::sqrt(covariance(4, 4)), 1e-6 * 60.0, 1e-11);
}

TEST(TorqueFreeArc, IsTheSameInPieces) {
  const ArcState whole = arc_from(kStart, kInertia_kg_m2, -60.0);
  ArcState at = start_of_arc(kStart);
  for (const double piece_s : {-1.0, -29.0, -30.0}) {
    at = torque_free_arc(at, kInertia_kg_m2, piece_s);
  }
  EXPECT_LT(angle_between_rad(at.body.q_icrf_body, whole.body.q_icrf_body), 1e-8);
  EXPECT_LT((at.slopes - whole.slopes).norm(), 1e-7 * whole.slopes.norm());
}

/// The moments of inertia cover all ratios up to the extreme ones.
TEST(TorqueFreeArc, AnUnknownInertiaAcceleratesByNoMoreThanSaid) {
  const Vector3d rate{0.01, -0.006, 0.002};
  const Vector3d most_rad_s2 = std::sqrt(3.0) * unknown_acceleration_rad_s2(rate);
  for (const Vector3d& moments : {Vector3d{120.0, 100.0, 140.0}, Vector3d{1.0, 1.0, 2.0},
                                  Vector3d{1.0, 2.0, 1.0}, Vector3d{2.0, 1.0, 1.0}}) {
    const Vector3d momentum = moments.cwiseProduct(rate);
    const Vector3d acceleration = momentum.cross(rate).cwiseQuotient(moments);
    EXPECT_TRUE((acceleration.array().abs() <= 1.000001 * most_rad_s2.array()).all());
  }
}

TEST(TorqueFreeArc, AnInertiaThatIsUnknownMovesNothing) {
  const ArcState at = arc_from(kStart, std::nullopt, -60.0);
  EXPECT_EQ(at.body.rate_body_rad_s, kStart.rate_body_rad_s);
  EXPECT_TRUE(at.slopes.middleCols<3>(6).isZero(0.0));
}

}  // namespace spindrift::torque_free_arc_test
