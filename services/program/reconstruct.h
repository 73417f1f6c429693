/// @file
/// `spindrift reconstruct`: computes the attitude at separation backwards from the star fixes, from
/// files or from the samples in the archive.

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
  std::optional<std::filesystem::path> mission;  ///< Empty: that of the archive's newest run.
  std::vector<std::filesystem::path> telemetry;  ///< Empty means the samples in the archive.
  std::filesystem::path db;
  std::optional<ReconstructionMethod> method;  ///< Empty means both methods.
  std::filesystem::path plot;                  ///< Empty means no plot.
  bool json = false;
};

/// The `do` of a request to the service that holds the archive (services/operator).
inline constexpr std::string_view kReconstructRequest = "reconstruct";

/// Answers such a request and stores a run. Safe to call from any thread.
nlohmann::json answer_reconstruct(const nlohmann::json& request, const std::filesystem::path& db,
                                  Archive& archive);

/// Reconstructs the separation and stores a run, here or through the service that holds the
/// archive, and prints the answer on standard output.
/// @return whether each method gave an attitude; InvalidConfiguration for bad input, before
///         anything is written; Unavailable for a failure while running.
Expected<bool> reconstruct(const ReconstructOptions& options);

}  // namespace spindrift
