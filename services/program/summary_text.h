/// @file
/// Formats the summary of a run as text and as JSON.

#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "pipelines/core/expected.h"
#include "services/processor/processor.h"
#include "services/processor/run_summary.h"

namespace spindrift {

/// Returns several lines, each with a line end.
std::string to_text(const RunSummary& summary);

nlohmann::json to_json(const RunSummary& summary);

nlohmann::json to_json(const SpinEstimate& estimate);

/// Returns the estimate on one line, for the log.
std::string to_text(const SpinEstimate& estimate);
std::string to_text(const AttitudeEstimate& attitude);
/// Returns the attitude at time T1 on one line.
std::string to_text(const ReconstructionProduct& reconstruction);

/// Reports on all runs of one command: as text, or one object with `db`, `runs`,
/// `other_spacecraft`.
/// @param db Archive that already holds the products and samples of the runs.
/// @return The errors of count_stored_edges.
Expected<std::string> report(const Processor& processor, const std::filesystem::path& db,
                             bool json);

}  // namespace spindrift
