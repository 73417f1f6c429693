/// @file
/// What a Prometheus server asks for.

#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "services/archive/archive.h"
#include "services/base/duration_histogram.h"

namespace spindrift {

struct ViewerCounts {
  std::size_t watching = 0;
  std::uint64_t dropped = 0;  ///< They took nothing any more.
};

/// In the text format. What is not known yet is left out.
/// @param state As in /api/v1/state. @param latencies Of results.
std::string metrics_text(const nlohmann::json& state, const ArchiveStatistics& archive,
                         const DurationHistogram& latencies, const ViewerCounts& viewers);

}  // namespace spindrift
