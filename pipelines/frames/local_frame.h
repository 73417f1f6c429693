/// @file
/// Positions on and above the Earth, and their north-east-down frames.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "pipelines/core/expected.h"

namespace spindrift {

/// Position by the normal of the ellipsoid (WGS-84).
struct GeodeticPlace {
  double latitude_rad;   ///< Geodetic latitude, north positive.
  double longitude_rad;  ///< Longitude, east positive.
  double height_km;      ///< Height above the ellipsoid.
};

/// Position by the line to the Earth's centre.
struct GeocentricPlace {
  double latitude_rad;
  double longitude_rad;
  double radius_km;
};

struct LocalFrame {
  Eigen::Vector3d origin_itrf_km;
  Eigen::Quaterniond q_itrf_ned;  ///< Down is opposite to the normal, or to the Earth's centre.
};

/// @return q_itrf_ned. At the north pole, north is away from the longitude's meridian; at the south
///         pole, along it.
Eigen::Quaterniond north_east_down(double latitude_rad, double longitude_rad);

/// @return InvalidInput for a latitude beyond 90 deg and for values that are not finite.
Expected<LocalFrame> local_frame(const GeodeticPlace& place);
Expected<LocalFrame> local_frame(const GeocentricPlace& place);

}  // namespace spindrift
