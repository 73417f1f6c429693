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

/// `direction_icrf` needs no unit length. At a celestial pole the right ascension is 0.
RaDec ra_dec_of(const Eigen::Vector3d& direction_icrf);

/// Angle between two directions, [0, pi], good to an ulp near 0 and pi; lengths do not matter.
double angle_between_rad(const Eigen::Vector3d& a, const Eigen::Vector3d& b);

/// Columns east and north: an orthonormal basis of the plane tangent to the sphere at `axis_icrf`.
/// At a celestial pole, where east has no meaning, it is the basis of right ascension 0.
Eigen::Matrix<double, 3, 2> tangent_basis(const Eigen::Vector3d& axis_icrf);

/// Turns a frame's third axis when the frame turns about its own first and second axes: from these
/// small angles to displacements in the tangent plane, east and north; a rotation or reflection.
Eigen::Matrix2d tangent_from_tilts(const Eigen::Quaterniond& q_icrf_frame);

/// The frame whose third axis is `axis_icrf`, by the shortest turn from ICRF: q_icrf_frame.
Eigen::Quaterniond frame_about(const Eigen::Vector3d& axis_icrf);

/// Of an axis that may point anywhere, in the tangent plane: its trace is the mean square of the
/// angle to any other.
Eigen::Matrix2d anywhere_covariance_rad2();

/// `angle_rad` wrapped into (-pi, pi].
double wrapped_rad(double angle_rad);

}  // namespace spindrift
