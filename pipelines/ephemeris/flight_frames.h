/// @file
/// The frames that attitudes in flight are told in: the orbit frame and the launch inertial frame.

#pragma once

#include <Eigen/Geometry>

#include "pipelines/core/expected.h"
#include "pipelines/ephemeris/orbit_state.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

/// Returns the orbit frame: z to the Earth's centre, y against the orbit normal, x = y x z, ahead.
/// @return q_icrf_orbit: v_icrf = q v_orbit q*. A body's attitude in the frame is q* q_icrf_body.
///         Unobservable where the velocity is vertical: there is no orbit normal.
Expected<Eigen::Quaterniond> orbit_frame(const OrbitState& spacecraft);

/// Launch site on the Earth's ellipsoid (WGS-84).
struct LaunchSite {
  double latitude_rad;   ///< Geodetic latitude, north positive.
  double longitude_rad;  ///< Longitude, east positive.
};

struct Launch {
  LaunchSite site;
  double azimuth_rad;  ///< Launch azimuth from north through east.
  TaiTime epoch;
};

/// Returns the launch inertial frame: north-east-down of the site at the epoch, turned about down
/// by the azimuth, so that x is horizontal along the azimuth; inertially fixed from then on. Its
/// error is that of `earth_orientation`, at most 14 arcsec.
/// @return q_icrf_launch. A launcher's attitude is q_icrf_launch q_launch_body.
Eigen::Quaterniond launch_frame(const Launch& launch);

}  // namespace spindrift
