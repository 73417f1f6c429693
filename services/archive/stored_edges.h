/// @file
/// Reads what the estimator `batch` needs of a run from the archive.

#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "pipelines/core/expected.h"
#include "pipelines/spin/batch/pass_edges.h"

namespace spindrift {

struct StoredEdges {
  std::string run_id;
  std::string config_sha256;                ///< Digest of the run's mission file.
  std::optional<std::string> orbit_sha256;  ///< Empty when the run had no orbit file.
  std::optional<SpinPrior> told_prior;  ///< Prior given by an operator, instead of the mission's.
  PassEdges pass;
};

/// Reads the edges of a run. @param run_id Empty for the spacecraft's newest run with revolutions.
/// @return InvalidConfiguration when there is no such run; otherwise errors as find_stored_passes.
Expected<StoredEdges> read_edges(const std::filesystem::path& archive,
                                 const std::string& spacecraft_id,
                                 const std::optional<std::string>& run_id);

}  // namespace spindrift
