/// @file
/// Directions in ICRF: right ascension and declination, angles between, the tangent plane.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace spindrift {

/// Right ascension in [0, 2 pi), declination in [-pi/2, pi/2].
struct RaDec {
  double ra_rad;
  double dec_rad;
};

Eigen::Vector3d direction_icrf(const RaDec& place);

/// Returns the place of a direction of any length. At a celestial pole the right ascension is 0.
RaDec ra_dec_of(const Eigen::Vector3d& direction_icrf);

/// Returns the angle between directions of any length, [0, pi]; to an ulp near 0 and pi.
double angle_between_rad(const Eigen::Vector3d& a, const Eigen::Vector3d& b);

/// Returns the columns east and north: an orthonormal basis of the plane tangent to the sphere at
/// `axis_icrf`. At a celestial pole, it is the basis of right ascension 0.
Eigen::Matrix<double, 3, 2> tangent_basis(const Eigen::Vector3d& axis_icrf);

/// Returns the map from small rotations of a frame about its own first and second axes to the
/// displacement of its third axis in the tangent plane, east and north; a rotation or reflection.
Eigen::Matrix2d tangent_from_tilts(const Eigen::Quaterniond& q_icrf_frame);

/// Returns q_icrf_frame with the third axis `axis_icrf`, by the shortest turn from ICRF.
Eigen::Quaterniond frame_about(const Eigen::Vector3d& axis_icrf);

/// Returns the covariance, in the tangent plane, of an axis that may point anywhere: its trace is
/// the mean square of the angle to any other direction.
Eigen::Matrix2d anywhere_covariance_rad2();

/// Returns `angle_rad` wrapped into (-pi, pi].
double wrapped_rad(double angle_rad);

}  // namespace spindrift
