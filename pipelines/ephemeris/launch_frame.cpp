#include "pipelines/ephemeris/launch_frame.h"

#include "pipelines/ephemeris/earth_orientation.h"
#include "pipelines/frames/angle.h"

namespace spindrift {

Eigen::Quaterniond north_east_down(const LaunchSite& site) {
  return Eigen::AngleAxisd{site.longitude_rad, Eigen::Vector3d::UnitZ()} *
         Eigen::AngleAxisd{-site.latitude_rad - kQuarter_rad, Eigen::Vector3d::UnitY()};
}

Eigen::Quaterniond launch_frame(const Launch& launch) {
  return earth_orientation(launch.epoch) * north_east_down(launch.site) *
         Eigen::AngleAxisd{launch.azimuth_rad, Eigen::Vector3d::UnitZ()};
}

}  // namespace spindrift
