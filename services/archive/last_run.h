/// @file
/// Describes how the newest run of a spacecraft was made.

#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "pipelines/core/expected.h"
#include "pipelines/time/tai_time.h"
#include "services/archive/records.h"

namespace spindrift {

struct LastRun {
  std::string run_id;
  std::vector<std::string> telemetry;  ///< As RunStart::telemetry.
  std::string software_version;
  std::string config_sha256;
  std::optional<std::string> orbit_sha256;  ///< Empty when the mission names no orbit file.
  std::optional<TaiTime> first_sample;      ///< Empty when no sample came.
  std::optional<TaiTime> last_sample;       ///< Empty when no sample came.
};

/// Finds the newest run of the spacecraft in this mode.
/// @return Empty when there is none; errors as find_stored_passes.
Expected<std::optional<LastRun>> find_last_run(const std::filesystem::path& archive,
                                               const std::string& spacecraft_id, RunMode mode);

/// Returns the first arrival of the spacecraft's newest run in any mode.
/// @return Empty when there is none; errors as find_stored_passes.
Expected<std::optional<RunPlace>> find_last_first_arrival(const std::filesystem::path& archive,
                                                          const std::string& spacecraft_id);

}  // namespace spindrift
