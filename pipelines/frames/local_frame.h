/// @file
/// Places on and above the Earth, and north-east-down there.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "pipelines/core/expected.h"

namespace spindrift {

/// By the ellipsoid's normal (WGS-84).
struct GeodeticPlace {
  double latitude_rad;   ///< North positive.
  double longitude_rad;  ///< East positive.
  double height_km;      ///< Above the ellipsoid.
};

/// By the line to the Earth's centre.
struct GeocentricPlace {
  double latitude_rad;
  double longitude_rad;
  double radius_km;
};

struct LocalFrame {
  Eigen::Vector3d origin_itrf_km;
  Eigen::Quaterniond q_itrf_ned;  ///< Down is against the normal, or to the Earth's centre.
};

/// @return q_itrf_ned, to the Earth's axes. At a pole north is away from the longitude's meridian
/// at
///         the north one, and along it at the south one.
Eigen::Quaterniond north_east_down(double latitude_rad, double longitude_rad);

/// @return InvalidInput for a latitude beyond 90 deg and for what is no number.
Expected<LocalFrame> local_frame(const GeodeticPlace& place);
Expected<LocalFrame> local_frame(const GeocentricPlace& place);

}  // namespace spindrift
