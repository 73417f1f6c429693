/// @file
/// `spindrift process`: the pipelines over recorded telemetry, into an archive.

#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "pipelines/core/expected.h"

namespace spindrift {

struct ProcessOptions {
  std::filesystem::path mission;
  std::vector<std::filesystem::path> telemetry;
  std::filesystem::path db;
  std::optional<std::string> label;  ///< That the run gets in the archive.
  bool strict = false;               ///< A bad row is an error.
  bool json = false;
};

/// Prints its summary on standard output. SIGINT and SIGTERM interrupt it: what was taken is stored
/// and summarised, and the run stays unfinished. A second one ends the program at once.
/// @return whether it came to its end; InvalidConfiguration for bad input, before anything is
/// written; Unavailable for a
///         failure while running.
Expected<bool> process(const ProcessOptions& options);

}  // namespace spindrift
