/// @file
/// `spindrift reconstruct`: the attitude at separation, backwards from the star fixes, from files
/// or from the samples in the archive.

#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "pipelines/core/expected.h"
#include "pipelines/reconstruction/reconstruction.h"

namespace spindrift {

struct ReconstructOptions {
  std::optional<std::filesystem::path> mission;  ///< Empty: that of the newest run in the archive.
  std::vector<std::filesystem::path> telemetry;  ///< Empty: the samples in the archive.
  std::filesystem::path db;
  std::optional<ReconstructionMethod> method;  ///< Empty: both.
  std::filesystem::path plot;                  ///< Empty: none.
  bool json = false;
};

/// Writes a run, and prints its answer on standard output.
/// @return whether each method gave one; InvalidConfiguration for bad input, before anything is
///         written; Unavailable for a failure while running.
Expected<bool> reconstruct(const ReconstructOptions& options);

}  // namespace spindrift
