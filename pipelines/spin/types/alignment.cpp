#include "pipelines/spin/types/alignment.h"

#include <array>

#include "pipelines/frames/angle.h"

namespace spindrift {

const SpinAlignmentKey& key_of(SpinAlignmentError error) {
  static constexpr std::array<SpinAlignmentKey, kSpinAlignmentErrors> kKeys = {{
      {"spin.sun_sensor.slit_cant_deg", "slit_cant_deg", kRadPerDeg},
      {"spin.sun_sensor.slit_separation_deg", "slit_separation_deg", kRadPerDeg},
      {"spin.ir.north.mount_angle_deg", "north_mount_angle_deg", kRadPerDeg},
      {"spin.ir.south.mount_angle_deg", "south_mount_angle_deg", kRadPerDeg},
      {"spin.ir.north.azimuth_deg", "north_azimuth_deg", kRadPerDeg},
      {"spin.ir.south.azimuth_deg", "south_azimuth_deg", kRadPerDeg},
      {"spin.horizon.co2_altitude_km", "co2_altitude_km", 1.0},
      {"spin.alignment.time_tag_s", "time_tag_s", 1.0},
  }};
  return kKeys.at(error);
}

}  // namespace spindrift
