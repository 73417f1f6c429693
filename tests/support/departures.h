/// @file
/// Queries on the result of a comparison with the ground model.

#pragma once

#include <map>
#include <string>
#include <vector>

#include "pipelines/ground_model/comparison/departure_watch.h"

namespace spindrift::testing {

using ByChannel = std::map<std::string, ChannelComparison>;

inline ByChannel by_channel(const std::vector<ChannelComparison>& channels) {
  ByChannel all;
  for (const ChannelComparison& channel : channels) {
    all.emplace(channel.channel.name, channel);
  }
  return all;
}

/// Returns when each departed channel left the model, in s after `start`.
inline std::map<std::string, double> departures_s(const ByChannel& all, TaiTime start) {
  std::map<std::string, double> departed;
  for (const auto& [name, channel] : all) {
    if (channel.departure) {
      departed.emplace(name, seconds_between(start, channel.departure->since));
    }
  }
  return departed;
}

}  // namespace spindrift::testing
