/// @file
/// `spindrift compare`: recorded telemetry, or that of the archive, against the ground model.

#pragma once

#include <filesystem>
#include <vector>

#include "pipelines/core/expected.h"

namespace spindrift {

struct CompareOptions {
  std::filesystem::path mission;
  std::vector<std::filesystem::path> telemetry;  ///< Empty: what the archive holds.
  std::filesystem::path db;                      ///< Empty: there is telemetry.
  std::filesystem::path model;                   ///< A scenario's file.
  std::filesystem::path plot;                    ///< Empty: none.
  bool json = false;
};

/// Prints the residuals of each channel, and since when flight is away, on standard output. Of an
/// archive a run is stored with both, and an alert for each departure.
/// @return InvalidConfiguration for bad input, and where nothing can be compared; Unavailable for a
///         failure while running.
Expected<void> compare(const CompareOptions& options);

}  // namespace spindrift
