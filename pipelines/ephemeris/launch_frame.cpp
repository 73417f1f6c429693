#include "pipelines/ephemeris/launch_frame.h"

#include "pipelines/ephemeris/earth_orientation.h"
#include "pipelines/frames/local_frame.h"

namespace spindrift {

Eigen::Quaterniond launch_frame(const Launch& launch) {
  return earth_orientation(launch.epoch) *
         north_east_down(launch.site.latitude_rad, launch.site.longitude_rad) *
         Eigen::AngleAxisd{launch.azimuth_rad, Eigen::Vector3d::UnitZ()};
}

}  // namespace spindrift
