/// @file
/// Reads what the archive holds for the reconstruction of a separation.

#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "pipelines/core/expected.h"
#include "pipelines/ephemeris/orbit_state.h"
#include "pipelines/three_axis/samples.h"

namespace spindrift {

struct StoredMission {
  std::string run_id;
  std::string config_toml;
  std::filesystem::path config_path;
  std::optional<std::string> orbit_sha256;  ///< Empty when the mission names no orbit file.
};

/// Returns the mission of the newest run of a three-axis spacecraft.
/// @return InvalidConfiguration when there is none; errors as open_for_reading.
Expected<StoredMission> find_stored_mission(const std::filesystem::path& archive);

struct SeparationSamples {
  std::vector<GyroSample> gyro;
  std::vector<SunDirection> sun;
  std::vector<StarFix> stars;
  std::vector<TimedOrbitState> orbit_states;
};

/// Reads the samples of a spacecraft from a time on, from all runs and in order of time. Samples
/// left out because their source's time was wrong are omitted, and so are those that operators
/// excluded in the newest run with samples. @param preferred_source Empty when there is none.
/// @return Errors as open_for_reading; Unavailable when reading fails.
Expected<SeparationSamples> find_separation_samples(const std::filesystem::path& archive,
                                                    const std::string& spacecraft_id,
                                                    const std::string& preferred_source,
                                                    TaiTime from);

}  // namespace spindrift
