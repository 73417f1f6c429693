/// @file
/// A run's summary for people and for programs.

#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "services/processor/run_summary.h"

namespace spindrift {

/// Several lines, ending in a line end.
std::string to_text(const RunSummary& summary);

nlohmann::json to_json(const RunSummary& summary);

/// All runs of one command: text, or one JSON object with `db` and `runs`.
std::string report(const std::vector<RunSummary>& summaries, const std::filesystem::path& db,
                   bool json);

}  // namespace spindrift
