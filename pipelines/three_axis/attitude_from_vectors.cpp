#include "pipelines/three_axis/attitude_from_vectors.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <array>

#include "pipelines/frames/angle.h"
#include "pipelines/statistics/symmetric_eigen.h"

namespace spindrift {
namespace {

/// @return Covariance of the attitude, rad^2, body axes.
Expected<Eigen::Matrix3d> observed(std::span<const ObservedDirection> directions) {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  for (const ObservedDirection& direction : directions) {
    information += information_of(direction);
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver{information};
  const double least = solver.eigenvalues()[0];
  const double most = solver.eigenvalues()[2];
  // Smallest ratio of the eigenvalues of the information matrix that exceeds rounding errors.
  if (!(least * kLargestSigma_rad * kLargestSigma_rad > 1.0 && least > 1e-14 * most)) {
    return Unexpected{
        {ErrorCode::Unobservable,
         fmt::format("{} directions do not determine the attitude: all lie so nearly along one "
                     "line that the turn about it is not known to {:.0f} deg",
                     directions.size(), degrees(kLargestSigma_rad))}};
  }
  return solver.eigenvectors() * solver.eigenvalues().cwiseInverse().asDiagonal() *
         solver.eigenvectors().transpose();
}

/// Returns orthonormal axes: along `first`, along the cross product, and completing the triad.
Eigen::Matrix3d triad_axes(const Eigen::Vector3d& first, const Eigen::Vector3d& second) {
  Eigen::Matrix3d axes;
  axes.col(0) = first.normalized();
  axes.col(1) = first.cross(second).normalized();
  axes.col(2) = axes.col(0).cross(axes.col(1));
  return axes;
}

}  // namespace

Eigen::Matrix3d information_of(const ObservedDirection& direction) {
  const Eigen::Vector3d along = direction.body.normalized();
  return (Eigen::Matrix3d::Identity() - along * along.transpose()) /
         (direction.sigma_rad * direction.sigma_rad);
}

Expected<UncertainAttitude> triad(const ObservedDirection& first, const ObservedDirection& second) {
  return observed(std::array{first, second}).map([&](const Eigen::Matrix3d& /*of_both*/) {
    const Eigen::Matrix3d R_ref_body =
        triad_axes(first.ref, second.ref) * triad_axes(first.body, second.body).transpose();
    const Eigen::Vector3d b1 = first.body.normalized();
    const Eigen::Vector3d b2 = second.body.normalized();
    const double first_rad2 = first.sigma_rad * first.sigma_rad;
    const double second_rad2 = second.sigma_rad * second.sigma_rad;
    return UncertainAttitude{
        .q_ref_body = Eigen::Quaterniond{R_ref_body}.normalized(),
        .covariance_rad2 = first_rad2 * Eigen::Matrix3d::Identity() +
                           (first_rad2 * b1.dot(b2) * (b1 * b2.transpose() + b2 * b1.transpose()) +
                            (second_rad2 - first_rad2) * b1 * b1.transpose()) /
                               b1.cross(b2).squaredNorm()};
  });
}

Expected<UncertainAttitude> q_method(std::span<const ObservedDirection> directions) {
  return observed(directions).map([&](const Eigen::Matrix3d& covariance_rad2) {
    Eigen::Matrix3d profile = Eigen::Matrix3d::Zero();
    Eigen::Vector3d turned = Eigen::Vector3d::Zero();
    for (const ObservedDirection& direction : directions) {
      const Eigen::Vector3d body = direction.body.normalized();
      const Eigen::Vector3d ref = direction.ref.normalized();
      const double weight = 1.0 / (direction.sigma_rad * direction.sigma_rad);
      profile += weight * body * ref.transpose();
      turned += weight * body.cross(ref);
    }
    Eigen::Matrix4d davenport;
    davenport.topLeftCorner<3, 3>() =
        profile + profile.transpose() - profile.trace() * Eigen::Matrix3d::Identity();
    davenport.topRightCorner<3, 1>() = turned;
    davenport.bottomLeftCorner<1, 3>() = turned.transpose();
    davenport(3, 3) = profile.trace();
    const Eigen::Vector4d best = symmetric_eigen(davenport).vectors.col(3);
    return UncertainAttitude{.q_ref_body = Eigen::Quaterniond{best},
                             .covariance_rad2 = covariance_rad2};
  });
}

}  // namespace spindrift
