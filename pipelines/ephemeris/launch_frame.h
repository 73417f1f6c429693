/// @file
/// The launch inertial frame.

#pragma once

#include <Eigen/Geometry>

#include "pipelines/time/tai_time.h"

namespace spindrift {

/// On the Earth's ellipsoid (WGS-84).
struct LaunchSite {
  double latitude_rad;   ///< Geodetic, north positive: of the ellipsoid's normal.
  double longitude_rad;  ///< East positive.
};

struct Launch {
  LaunchSite site;
  double azimuth_rad;  ///< From north by east.
  TaiTime epoch;
};

/// The launch inertial frame: north-east-down of the site at the epoch, turned about down by the
/// azimuth, so that x is level and along it; at rest among the stars from then on. Its error is
/// that of `earth_orientation`, at most 14 arcsec.
/// @return q_icrf_launch. A launcher's attitude is that times q_launch_body.
Eigen::Quaterniond launch_frame(const Launch& launch);

}  // namespace spindrift
