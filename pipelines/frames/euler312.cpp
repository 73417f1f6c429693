#include "pipelines/frames/euler312.h"

#include <cmath>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"

namespace spindrift {
namespace {

constexpr double kNearSingular_rad = 1.0 * kRadPerDeg;

}  // namespace

Eigen::Matrix3d attitude_matrix(const Euler312& angles) {
  return quaternion_of(angles).conjugate().toRotationMatrix();
}

Eigen::Quaterniond quaternion_of(const Euler312& angles) {
  return Eigen::AngleAxisd{angles.psi_rad, Eigen::Vector3d::UnitZ()} *
         Eigen::AngleAxisd{angles.phi_rad, Eigen::Vector3d::UnitX()} *
         Eigen::AngleAxisd{angles.theta_rad, Eigen::Vector3d::UnitY()};
}

/// Computes half sum and half difference of theta and psi; the singularity spoils only one of them,
/// which does not matter there (after Bernardes and Viollet 2022). With c, s the cosine and sine of
/// phi / 2 the quaternion of the three turns has
///     w + x = (c + s) cos sum, y + z = (c + s) sin sum,
///     w - x = (c - s) cos difference, y - z = (c - s) sin difference.
Euler312Reading euler312_of(const Eigen::Quaterniond& q_ref_body) {
  const Eigen::Quaterniond& q = q_ref_body;
  const double half_sum_rad = std::atan2(q.y() + q.z(), q.w() + q.x());
  const double half_difference_rad = std::atan2(q.y() - q.z(), q.w() - q.x());
  const double c_plus_s = std::hypot(q.y() + q.z(), q.w() + q.x());
  const double c_minus_s = std::hypot(q.y() - q.z(), q.w() - q.x());
  const double phi_rad = 2.0 * std::atan2(c_plus_s, c_minus_s) - kQuarter_rad;
  return {.angles = {.phi_rad = phi_rad,
                     .theta_rad = wrapped_rad(half_sum_rad + half_difference_rad),
                     .psi_rad = wrapped_rad(half_sum_rad - half_difference_rad)},
          .near_singular = std::abs(phi_rad) > kQuarter_rad - kNearSingular_rad};
}

}  // namespace spindrift
