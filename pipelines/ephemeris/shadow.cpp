#include "pipelines/ephemeris/shadow.h"

#include <Eigen/Geometry>

#include "pipelines/frames/wgs84.h"

namespace spindrift {

bool is_in_shadow(const Eigen::Vector3d& position_icrf_km, const Eigen::Vector3d& sun_icrf) {
  return position_icrf_km.dot(sun_icrf) < 0.0 &&
         position_icrf_km.cross(sun_icrf).norm() < wgs84::kEquatorialRadius_km;
}

}  // namespace spindrift
