/// @file
/// `spindrift compare`: compares recorded or archived telemetry with the ground model.

#pragma once

#include <filesystem>
#include <vector>

#include "pipelines/core/expected.h"

namespace spindrift {

struct CompareOptions {
  std::filesystem::path mission;
  std::vector<std::filesystem::path> telemetry;  ///< Empty means the telemetry in the archive.
  std::filesystem::path db;                      ///< Empty when telemetry files are given.
  std::filesystem::path model;                   ///< Path of a scenario file.
  std::filesystem::path plot;                    ///< Empty means no plot.
  bool json = false;
};

/// Prints the residuals of each channel and when it departed from the model. Of archived telemetry
/// it stores a run with both, and an alert for each departure.
/// @return InvalidConfiguration for bad input, and where nothing can be compared; Unavailable for a
///         failure while running.
Expected<void> compare(const CompareOptions& options);

}  // namespace spindrift
