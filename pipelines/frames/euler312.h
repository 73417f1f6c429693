/// @file
/// Euler angles 3-1-2: about z by psi, about the new x by phi, about the newest y by theta.
///
///     A_body_ref = Ry(theta) Rx(phi) Rz(psi) = R(q_ref_body)^T,    v_body = A_body_ref v_ref
///
/// The reference frame is ICRF or the orbit frame. At phi = +-90 deg theta and psi turn about one
/// axis: angles are for display, the quaternion is the state.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace spindrift {

struct Euler312 {
  double phi_rad;    ///< [-pi/2, pi/2]
  double theta_rad;  ///< (-pi, pi]
  double psi_rad;    ///< (-pi, pi]
};

Eigen::Matrix3d attitude_matrix(const Euler312& angles);
Eigen::Quaterniond quaternion_of(const Euler312& angles);

struct Euler312Reading {
  Euler312 angles;  ///< The angles reproduce the attitude to 1e-15 everywhere.
  /// True within a degree of phi = +-90 deg: there an attitude error is 57 times as large, or more,
  /// in theta and psi, of which only theta + psi (+90 deg) or theta - psi (-90 deg) is well known.
  bool near_singular;
};

/// @param q_ref_body Needs no unit length.
Euler312Reading euler312_of(const Eigen::Quaterniond& q_ref_body);

}  // namespace spindrift
