/// @file
/// Queries on the result of a comparison with the ground model.

#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "pipelines/ground_model/comparison/departure_watch.h"
#include "tests/support/matchers.h"

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

/// Expects that this channel alone departed, between these times.
inline void expect_only(const std::map<std::string, double>& departed_s, const std::string& channel,
                        const std::pair<double, double>& between_s) {
  EXPECT_THAT(departed_s,
              ElementsAre(::testing::Pair(channel, AllOf(::testing::Ge(between_s.first),
                                                         ::testing::Le(between_s.second)))));
}

}  // namespace spindrift::testing
