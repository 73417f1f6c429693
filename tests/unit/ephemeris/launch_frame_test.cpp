#include <cmath>

#include "pipelines/ephemeris/earth_orientation.h"
#include "pipelines/ephemeris/flight_frames.h"
#include "pipelines/frames/angle.h"
#include "pipelines/frames/euler312.h"
#include "pipelines/frames/local_frame.h"
#include "pipelines/frames/rotation_vector.h"
#include "pipelines/time/utc.h"
#include "tests/support/matchers.h"

namespace spindrift::launch_frame_test {

using Eigen::Vector3d;

constexpr double kRounding = 4e-15;
// Taiyuan, with a launch to the south-south-west into a sun-synchronous orbit.
constexpr LaunchSite kSite{.latitude_rad = 38.849 * kRadPerDeg,
                           .longitude_rad = 111.608 * kRadPerDeg};
constexpr double kAzimuth_rad = 190.0 * kRadPerDeg;

TEST(LaunchFrame, LooksAlongTheAzimuthAndDown) {
  const TaiTime epoch = parse_utc("2026-03-01T03:45:00").value();
  const Eigen::Quaterniond q_ned_icrf =
      (earth_orientation(epoch) * north_east_down(kSite.latitude_rad, kSite.longitude_rad))
          .conjugate();
  const Eigen::Quaterniond q_ned_launch =
      q_ned_icrf * launch_frame({.site = kSite, .azimuth_rad = kAzimuth_rad, .epoch = epoch});
  EXPECT_NEAR((q_ned_launch * Vector3d::UnitX() -
               Vector3d{std::cos(kAzimuth_rad), std::sin(kAzimuth_rad), 0.0})
                  .norm(),
              0.0, kRounding);
  EXPECT_NEAR((q_ned_launch * Vector3d::UnitZ() - Vector3d::UnitZ()).norm(), 0.0, kRounding);
}

TEST(LaunchFrame, ALauncherLevelAtTheSiteIsInTheOrbitFrameAsTheOrbitRunsThere) {
  // The orbit passes over the site at the epoch, level and along the azimuth in inertial space, so
  // the orbit frame differs from the launch frame only by the deflection of the vertical.
  const TaiTime epoch = parse_utc("2026-03-01T03:45:00").value();
  const Eigen::Quaterniond q_icrf_launch =
      launch_frame({.site = kSite, .azimuth_rad = kAzimuth_rad, .epoch = epoch});
  const Vector3d site_itrf_km =
      local_frame(GeodeticPlace{kSite.latitude_rad, kSite.longitude_rad, 0.0})->origin_itrf_km;
  const auto q_icrf_orbit =
      orbit_frame({.position_icrf_km = 1.1 * (earth_orientation(epoch) * site_itrf_km),
                   .velocity_icrf_km_s = 7.5 * (q_icrf_launch * Vector3d::UnitX())})
          .value();
  const double vertical_rad = 11.3 / 60.0 * kRadPerDeg;
  EXPECT_NEAR(angle_between_rad(q_icrf_orbit, q_icrf_launch), vertical_rad, 0.01 * vertical_rad);

  // A launcher yawed by 30 deg to the right is yawed by as much in the orbit frame.
  const Eigen::Quaterniond q_icrf_body =
      q_icrf_launch * quaternion_of({0.0, 0.0, 30.0 * kRadPerDeg});
  const Euler312 angles = euler312_of(q_icrf_orbit.conjugate() * q_icrf_body).angles;
  EXPECT_NEAR(degrees(angles.psi_rad), 30.0, 0.05);
  EXPECT_NEAR(degrees(std::hypot(angles.phi_rad, angles.theta_rad)), degrees(vertical_rad), 0.01);
}

}  // namespace spindrift::launch_frame_test
