/// @file
/// A pass of flight held against the ground model, for people and programs.

#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pipelines/ground_model/comparison/model_comparison.h"

namespace spindrift {

struct ComparisonReport {
  std::string spacecraft_id;
  std::filesystem::path model;  ///< The scenario's file.
  ModelSpan span;               ///< Of the model.
  double band_sigmas;
  std::vector<ChannelComparison> channels;
};

/// What departs first; null where nothing does.
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
