/// @file
/// The lines by which a mission file or scenario says that it is exactly true, as simulated passes
/// are unless their scenario says otherwise.

#pragma once

#include <string_view>

namespace spindrift {

inline constexpr std::string_view kExactSpin = R"(
[spin.alignment]
slit_cant_deg = 0
slit_separation_deg = 0
north_mount_angle_deg = 0
south_mount_angle_deg = 0
north_azimuth_deg = 0
south_azimuth_deg = 0
co2_altitude_km = 0
)";

inline constexpr std::string_view kExactThreeAxis = R"(
[three_axis.alignment]
star_tracker_deg = 0
sun_sensor_deg = 0
magnetometer_deg = 0
magnetometer_bias_nt = 0
gyro_scale = 0
gyro_deg = 0
time_tag_s = 0
inertia_fraction = 0
)";

}  // namespace spindrift
