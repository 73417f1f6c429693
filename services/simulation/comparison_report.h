/// @file
/// Result of comparing the flight data of a pass with the ground model.

#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pipelines/ground_model/comparison/model_comparison.h"

namespace spindrift {

struct ComparisonReport {
  std::string spacecraft_id;
  std::filesystem::path model;  ///< Scenario file of the model.
  ModelSpan span;               ///< Time span of the model.
  double band_sigmas;
  std::vector<ChannelComparison> channels;
};

/// Returns the channel that departs first; null where none does.
inline const ChannelComparison* first_departure(const ComparisonReport& report) {
  const ChannelComparison* first = nullptr;
  for (const ChannelComparison& channel : report.channels) {
    if (channel.departure &&
        (first == nullptr || channel.departure->since < first->departure->since)) {
      first = &channel;
    }
  }
  return first;
}

}  // namespace spindrift
