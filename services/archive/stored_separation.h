/// @file
/// What the archive holds that a separation can be reconstructed from.

#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "pipelines/core/expected.h"
#include "pipelines/ephemeris/timed_orbit_state.h"
#include "pipelines/three_axis/samples.h"

namespace spindrift {

/// Of a run.
struct StoredMission {
  std::string run_id;
  std::string config_toml;
  std::filesystem::path config_path;
  std::optional<std::string> orbit_sha256;  ///< Of the orbit file, where it names one.
};

/// That of the newest run of a three-axis spacecraft.
/// @return InvalidConfiguration where there is none; as open_for_reading.
Expected<StoredMission> find_stored_mission(const std::filesystem::path& archive);

struct SeparationSamples {
  std::vector<GyroSample> gyro;
  std::vector<SunDirection> sun;
  std::vector<StarFix> stars;
  std::vector<TimedOrbitState> orbit_states;
};

/// Of a spacecraft from a time on, in order of time, whatever run took them, but for those that a
/// run left out since the time of their source was wrong, and for what an operator had the newest
/// run that took samples leave out.
/// @param preferred_source As read_between.
/// @return As open_for_reading; Unavailable when reading fails.
Expected<SeparationSamples> find_separation_samples(const std::filesystem::path& archive,
                                                    const std::string& spacecraft_id,
                                                    const std::string& preferred_source,
                                                    TaiTime from);

}  // namespace spindrift
