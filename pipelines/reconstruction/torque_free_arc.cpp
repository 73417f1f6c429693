#include "pipelines/reconstruction/torque_free_arc.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

#include "pipelines/frames/rotation_vector.h"

namespace spindrift {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

struct RigidBody {
  explicit RigidBody(const std::optional<Matrix3d>& inertia_kg_m2)
      : kg_m2{inertia_kg_m2.value_or(Matrix3d::Identity())}, inverse{kg_m2.inverse()} {
    const Eigen::SelfAdjointEigenSolver<Matrix3d> principal{kg_m2};
    for (int i = 0; inertia_kg_m2 && i < 3; ++i) {
      const Vector3d axis = principal.eigenvectors().col(i);
      changes[static_cast<std::size_t>(i)] = principal.eigenvalues()[i] * axis * axis.transpose();
    }
  }

  Matrix3d kg_m2;
  Matrix3d inverse;
  /// Derivatives by the relative change of each principal moment; zero for a constant rate.
  std::array<Matrix3d, 3> changes{Matrix3d::Zero(), Matrix3d::Zero(), Matrix3d::Zero()};
};

/// Holds the integration state; used for its time derivative as well. The quaternion is x y z w.
struct State {
  Eigen::Vector4d q;
  Vector3d rate;
  ArcSlopes slopes;

  State operator+(const State& other) const {
    return {q + other.q, rate + other.rate, slopes + other.slopes};
  }
  friend State operator*(double factor, const State& state) {
    return {factor * state.q, factor * state.rate, factor * state.slopes};
  }
};

State change_of(const State& at, const RigidBody& body) {
  const Vector3d momentum = body.kg_m2 * at.rate;
  const Vector3d acceleration = -(body.inverse * at.rate.cross(momentum));
  const Eigen::Quaterniond q{at.q};
  State change;
  change.q = 0.5 * (q * Eigen::Quaterniond{0.0, at.rate.x(), at.rate.y(), at.rate.z()}).coeffs();
  change.rate = acceleration;
  const Matrix3d cross = cross_matrix(at.rate);
  const Matrix3d by_rate = body.inverse * (cross_matrix(momentum) - cross * body.kg_m2);
  change.slopes.topRows<3>() = -cross * at.slopes.topRows<3>() + at.slopes.bottomRows<3>();
  change.slopes.bottomRows<3>() = by_rate * at.slopes.bottomRows<3>();
  for (int i = 0; i < 3; ++i) {
    const Matrix3d& moment = body.changes[static_cast<std::size_t>(i)];
    change.slopes.block<3, 1>(3, 6 + i) -=
        body.inverse * (moment * acceleration + at.rate.cross(moment * at.rate));
  }
  change.slopes.block<3, 3>(3, 9) += Matrix3d::Identity();
  return change;
}

State stepped(const State& at, const RigidBody& body, double step_s) {
  const State a = change_of(at, body);
  const State b = change_of(at + 0.5 * step_s * a, body);
  const State c = change_of(at + 0.5 * step_s * b, body);
  const State d = change_of(at + step_s * c, body);
  State next = at + step_s / 6.0 * (a + 2.0 * b + 2.0 * c + d);
  next.q.normalize();
  return next;
}

}  // namespace

ArcState start_of_arc(const BodyState& body) {
  ArcState start{.body = body, .slopes = ArcSlopes::Zero()};
  start.slopes.leftCols<6>().setIdentity();
  return start;
}

ArcState torque_free_arc(const ArcState& from, const std::optional<Matrix3d>& inertia_kg_m2,
                         double duration_s) {
  const RigidBody body{inertia_kg_m2};
  State at{from.body.q_icrf_body.normalized().coeffs(), from.body.rate_body_rad_s, from.slopes};
  const double turned_rad = from.body.rate_body_rad_s.norm() * std::abs(duration_s);
  const double steps = std::max(1.0, std::ceil(turned_rad / 0.01));
  for (double i = 0.0; i < steps; ++i) {
    at = stepped(at, body, duration_s / steps);
  }
  return {.body = {.q_icrf_body = Eigen::Quaterniond{at.q}, .rate_body_rad_s = at.rate},
          .slopes = at.slopes};
}

Vector3d unknown_acceleration_rad_s2(const Vector3d& rate_body_rad_s) {
  const Vector3d& w = rate_body_rad_s;
  return Vector3d{w.y() * w.z(), w.z() * w.x(), w.x() * w.y()}.cwiseAbs() / std::sqrt(3.0);
}

Eigen::Matrix<double, 6, 6> covariance_of(const ArcSlopes& slopes, const ArcCovariance& errors) {
  const auto inertia = slopes.middleCols<3>(6);
  const Eigen::Matrix<double, 6, 3> accelerated =
      slopes.rightCols<3>() * errors.acceleration_rad_s2.asDiagonal();
  return slopes.leftCols<6>() * errors.start * slopes.leftCols<6>().transpose() +
         std::pow(errors.inertia_fraction, 2) * inertia * inertia.transpose() +
         accelerated * accelerated.transpose();
}

}  // namespace spindrift
