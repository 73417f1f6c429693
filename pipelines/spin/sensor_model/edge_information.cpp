#include "pipelines/spin/sensor_model/edge_information.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>

#include "pipelines/spin/sensor_model/geometry.h"

namespace spindrift {
namespace {

// Relative eigenvalue below which phase, rate and drift are not separated, as with edges of one
// time.
constexpr double kLeastShare = 1e-12;

using Slope = Eigen::Matrix<double, 5, 1>;

/// Scales the matrix to a unit diagonal, since dt^2 and a tilt differ by ten orders.
Eigen::Matrix3d pseudo_inverse(const Eigen::Matrix3d& normal) {
  Eigen::Vector3d unit = Eigen::Vector3d::Zero();
  for (Eigen::Index i = 0; i < 3; ++i) {
    unit[i] = normal(i, i) > 0.0 ? 1.0 / std::sqrt(normal(i, i)) : 0.0;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> scaled{unit.asDiagonal() * normal *
                                                              unit.asDiagonal()};
  Eigen::Vector3d inverse = Eigen::Vector3d::Zero();
  for (Eigen::Index i = 0; i < 3; ++i) {
    if (scaled.eigenvalues()[i] > kLeastShare) {
      inverse[i] = 1.0 / scaled.eigenvalues()[i];
    }
  }
  return unit.asDiagonal() * scaled.eigenvectors() * inverse.asDiagonal() *
         scaled.eigenvectors().transpose() * unit.asDiagonal();
}

}  // namespace

void EdgeInformation::add(const PredictedEdge& edge, double dt_s, double sigma_rad, double weight) {
  const Slope slope{edge.phase_per_rotation.x(), edge.phase_per_rotation.y(), -1.0, -dt_s,
                    -0.5 * dt_s * dt_s};
  normal_ += weight / (sigma_rad * sigma_rad) * slope * slope.transpose();
}

std::optional<Eigen::Matrix2d> EdgeInformation::axis_covariance_rad2() const {
  const Eigen::Matrix<double, 2, 3> shared = normal_.topRightCorner<2, 3>();
  const Eigen::Matrix2d information =
      normal_.topLeftCorner<2, 2>() -
      shared * pseudo_inverse(normal_.bottomRightCorner<3, 3>()) * shared.transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> directions;
  directions.computeDirect(information, Eigen::EigenvaluesOnly);
  if (!(directions.eigenvalues().minCoeff() >
        1.0 / (kLeastDetermined_rad * kLeastDetermined_rad))) {
    return std::nullopt;
  }
  // A tilt about the first axis moves the spin axis against the second.
  Eigen::Matrix2d axis_from_tilts;
  axis_from_tilts << 0.0, 1.0, -1.0, 0.0;
  return axis_from_tilts * information.inverse() * axis_from_tilts.transpose();
}

}  // namespace spindrift
