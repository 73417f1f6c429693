/// @file
/// What the archive holds of a run for the estimator `batch`.

#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "pipelines/core/expected.h"
#include "pipelines/spin/batch/pass_edges.h"

namespace spindrift {

struct StoredEdges {
  std::string run_id;
  std::string config_sha256;                ///< Of the mission file of the run.
  std::optional<std::string> orbit_sha256;  ///< Of its orbit file, if it had one.
  std::optional<SpinPrior> told_prior;      ///< By an operator, in the place of the mission's.
  PassEdges pass;
};

/// @param run_id Empty: the newest of the spacecraft that has revolutions.
/// @return InvalidInput where there is no such run; otherwise as find_stored_passes.
Expected<StoredEdges> read_edges(const std::filesystem::path& archive,
                                 const std::string& spacecraft_id,
                                 const std::optional<std::string>& run_id);

}  // namespace spindrift
