/// @file
/// A run's summary for people and for programs.

#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "pipelines/core/expected.h"
#include "services/processor/processor.h"
#include "services/processor/run_summary.h"

namespace spindrift {

/// Several lines, ending in a line end.
std::string to_text(const RunSummary& summary);

nlohmann::json to_json(const RunSummary& summary);

nlohmann::json to_json(const SpinEstimate& estimate);

/// An estimate on one line, for the log.
std::string to_text(const SpinEstimate& estimate);
std::string to_text(const AttitudeEstimate& attitude);
/// Its T1.
std::string to_text(const ReconstructionProduct& reconstruction);

/// All runs of one command: text, or one JSON object with `db`, `runs` and `other_spacecraft`.
/// @param db Read for what is stored: the runs' products and samples must be in it.
/// @return as count_stored_edges.
Expected<std::string> report(const Processor& processor, const std::filesystem::path& db,
                             bool json);

}  // namespace spindrift
