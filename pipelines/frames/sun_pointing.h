/// @file
/// The attitude to the Sun that an analog sun sensor gives: two angles, both zero where the body's
/// -z looks at the Sun. Li 2017, eq. 5, 6, 14 to 17; eq. 5 and 6 as printed hold for sz > 0 only.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "pipelines/core/expected.h"

namespace spindrift {

struct SunPointing {
  double phi_rad;    ///< -atan2(sy, -sz), from -z to the Sun in the y-z plane.
  double theta_rad;  ///< atan2(sx, -sz), likewise in the x-z plane.
};

/// @param sun_body Needs no unit length. Without x and z, or y and z, that angle is 0.
SunPointing sun_pointing_of(const Eigen::Vector3d& sun_body);

/// Unit vector to the Sun, body axes.
/// @return InvalidInput where one angle has the Sun ahead (of -z) and the other behind;
///         Unobservable within 1e-9 of sz = 0, where both are +-90 deg whatever the Sun's place.
Expected<Eigen::Vector3d> sun_body_of(const SunPointing& pointing);

/// The attitude nearest to `q_ref_body` that has the direction `ref` of the reference frame at
/// `body` in the body: no turn about the direction itself, which one direction cannot tell.
/// Directions need no unit length; where they are opposite, the turn is about any axis across them.
Eigen::Quaterniond turned_least(const Eigen::Quaterniond& q_ref_body, const Eigen::Vector3d& ref,
                                const Eigen::Vector3d& body);

/// The attitude, in ICRF or the orbit frame, that has the Sun where the sensor sees it (eq. 14 to
/// 17).
/// @param q_ref_body What is known of it besides; `sun_ref` in the same frame.
/// @return As `sun_body_of`.
Expected<Eigen::Quaterniond> attitude_with(const SunPointing& pointing,
                                           const Eigen::Quaterniond& q_ref_body,
                                           const Eigen::Vector3d& sun_ref);

}  // namespace spindrift
