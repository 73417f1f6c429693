/// @file
/// Attitude to the Sun by the two angles of an analog sun sensor, both zero where the body's -z
/// points to the Sun. Li 2017, eq. 5, 6, 14 to 17; eq. 5 and 6 as printed hold for sz > 0 only.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "pipelines/core/expected.h"

namespace spindrift {

struct SunPointing {
  double phi_rad;    ///< -atan2(sy, -sz): angle from -z to the Sun in the y-z plane.
  double theta_rad;  ///< atan2(sx, -sz): angle from -z to the Sun in the x-z plane.
};

/// @param sun_body Needs no unit length. An angle whose two components are both 0 is 0.
SunPointing sun_pointing_of(const Eigen::Vector3d& sun_body);

/// Returns the unit vector to the Sun, body axes.
/// @return InvalidInput where one angle has the Sun on the side of -z and the other opposite;
///         Unobservable within 1e-9 of sz = 0, where both are +-90 deg for any Sun.
Expected<Eigen::Vector3d> sun_body_of(const SunPointing& pointing);

/// Returns the attitude nearest to `q_ref_body` that has the direction `ref` of the reference frame
/// at `body` in the body. It does not turn about the direction, which one direction cannot tell.
/// Directions need no unit length; for opposite ones the turn is about any axis across them.
Eigen::Quaterniond turned_least(const Eigen::Quaterniond& q_ref_body, const Eigen::Vector3d& ref,
                                const Eigen::Vector3d& body);

/// Returns the attitude in the reference frame with the Sun where the sensor sees it (eq. 14 to
/// 17).
/// @param q_ref_body Prior attitude, in the frame of `sun_ref`.
/// @return Errors of `sun_body_of`.
Expected<Eigen::Quaterniond> attitude_with(const SunPointing& pointing,
                                           const Eigen::Quaterniond& q_ref_body,
                                           const Eigen::Vector3d& sun_ref);

}  // namespace spindrift
