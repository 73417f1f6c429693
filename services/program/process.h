/// @file
/// `spindrift process`: runs the pipelines over recorded telemetry into an archive.

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
  std::optional<std::string> label;  ///< Label of the run in the archive.
  bool strict = false;               ///< A bad row is an error.
  bool json = false;
};

/// Prints the summary of the run on standard output. SIGINT and SIGTERM interrupt the run: what was
/// taken is stored and summarised, and the run stays unfinished. A second signal ends the program
/// at once.
/// @return whether the run came to its end; InvalidConfiguration for bad input, before anything is
///         written; Unavailable for a failure while running.
Expected<bool> process(const ProcessOptions& options);

}  // namespace spindrift
