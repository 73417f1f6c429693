#include "pipelines/ephemeris/flight_frames.h"

#include <fmt/format.h>

#include "pipelines/ephemeris/earth_orientation.h"
#include "pipelines/frames/local_frame.h"

namespace spindrift {

Expected<Eigen::Quaterniond> orbit_frame(const OrbitState& spacecraft) {
  constexpr double kFewestAcross = 1e-9;  // Sine of the angle from the vertical to the velocity.
  const Eigen::Vector3d& position_km = spacecraft.position_icrf_km;
  const Eigen::Vector3d& velocity_km_s = spacecraft.velocity_icrf_km_s;
  const Eigen::Vector3d normal = position_km.cross(velocity_km_s);
  if (!(normal.norm() > kFewestAcross * position_km.norm() * velocity_km_s.norm())) {
    return Unexpected{
        {ErrorCode::Unobservable,
         fmt::format("no orbit frame: the velocity ({}, {}, {}) km/s lies along the position "
                     "({}, {}, {}) km",
                     velocity_km_s.x(), velocity_km_s.y(), velocity_km_s.z(), position_km.x(),
                     position_km.y(), position_km.z())}};
  }
  Eigen::Matrix3d R_icrf_orbit;
  R_icrf_orbit.col(2) = -position_km.normalized();
  R_icrf_orbit.col(1) = -normal.normalized();
  R_icrf_orbit.col(0) = R_icrf_orbit.col(1).cross(R_icrf_orbit.col(2));
  return Eigen::Quaterniond{R_icrf_orbit};
}

Eigen::Quaterniond launch_frame(const Launch& launch) {
  return earth_orientation(launch.epoch) *
         north_east_down(launch.site.latitude_rad, launch.site.longitude_rad) *
         Eigen::AngleAxisd{launch.azimuth_rad, Eigen::Vector3d::UnitZ()};
}

}  // namespace spindrift
