/// @file
/// A run's summary for people and for programs.

#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "services/processor/run_summary.h"

namespace spindrift {

/// Several lines, ending in a line end.
std::string to_text(const RunSummary& summary);

nlohmann::json to_json(const RunSummary& summary);

/// An estimate on one line, for the log.
std::string to_text(const SpinEstimate& estimate);

/// All runs of one command: text, or one JSON object with `db`, `runs` and `other_spacecraft`.
/// @param other_spacecraft How many samples came of each spacecraft without a mission.
std::string report(const std::vector<RunSummary>& summaries,
                   const std::map<std::string, std::int64_t>& other_spacecraft,
                   const std::filesystem::path& db, bool json);

}  // namespace spindrift
