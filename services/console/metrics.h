/// @file
/// Metrics of the service for a Prometheus server.

#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "services/archive/archive.h"
#include "services/base/duration_histogram.h"

namespace spindrift {

struct ViewerCounts {
  std::size_t watching = 0;
  std::uint64_t dropped = 0;  ///< Viewers dropped because they stopped reading.
};

/// Returns the metrics in Prometheus text format. Unknown values are left out.
/// @param state As in /api/v1/state. @param latencies Latencies of results.
/// @param webhook_failures How often the webhook did not take alerts; empty when there is none.
std::string metrics_text(const nlohmann::json& state, const ArchiveStatistics& archive,
                         const DurationHistogram& latencies, const ViewerCounts& viewers,
                         std::optional<std::int64_t> webhook_failures = {});

}  // namespace spindrift
