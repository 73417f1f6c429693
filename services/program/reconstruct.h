/// @file
/// `spindrift reconstruct`: the attitude at separation, backwards from the star fixes, from files
/// or from the samples in the archive.

#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string_view>
#include <vector>

#include "pipelines/core/expected.h"
#include "pipelines/reconstruction/reconstruction.h"
#include "services/archive/archive.h"

namespace spindrift {

struct ReconstructOptions {
  std::optional<std::filesystem::path> mission;  ///< Empty: that of the newest run in the archive.
  std::vector<std::filesystem::path> telemetry;  ///< Empty: the samples in the archive.
  std::filesystem::path db;
  std::optional<ReconstructionMethod> method;  ///< Empty: both.
  std::filesystem::path plot;                  ///< Empty: none.
  bool json = false;
};

/// `do` of the request for it to a service that holds the archive (services/requests).
inline constexpr std::string_view kReconstructRequest = "reconstruct";

/// Of that service, which stores a run in its archive. On any thread.
nlohmann::json answer_reconstruct(const nlohmann::json& request, const std::filesystem::path& db,
                                  Archive& archive);

/// Writes a run, or has it written by the service that holds the archive, and prints its answer on
/// standard output.
/// @return whether each method gave one; InvalidConfiguration for bad input, before anything is
///         written; Unavailable for a failure while running.
Expected<bool> reconstruct(const ReconstructOptions& options);

}  // namespace spindrift
