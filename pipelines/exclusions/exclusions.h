/// @file
/// The operator actions that exclude channels and time segments of telemetry, and what they
/// exclude.

#pragma once

#include <algorithm>
#include <iterator>
#include <map>
#include <optional>
#include <vector>

#include "pipelines/time/tai_time.h"

namespace spindrift {

/// @tparam Channel Pulse channel of a spinner or sample kind of a three-axis spacecraft.
template <class Channel>
struct ExcludeChannel {
  Channel channel;
};

template <class Channel>
struct IncludeChannel {
  Channel channel;
};

template <class Channel>
struct ExcludeSegment {
  TaiTime from;
  TaiTime to;                      ///< End, exclusive.
  std::optional<Channel> channel;  ///< Empty for all channels.
};

template <class Channel>
class Exclusions {
 public:
  /// @name Actions that apply to telemetry from `from` on
  /// @{
  void apply(TaiTime from, const ExcludeChannel<Channel>& action) {
    is_out_[action.channel].insert_or_assign(from, true);
  }
  void apply(TaiTime from, const IncludeChannel<Channel>& action) {
    is_out_[action.channel].insert_or_assign(from, false);
  }
  void apply(TaiTime from, const ExcludeSegment<Channel>& action) {
    segments_.push_back(action);
    segments_.back().from = std::max(from, action.from);
  }
  /// @}

  bool hold(TaiTime t, Channel channel) const {
    const auto said = is_out_.find(channel);
    if (said != is_out_.end()) {
      const auto later = said->second.upper_bound(t);
      if (later != said->second.begin() && std::prev(later)->second) {
        return true;
      }
    }
    return std::any_of(segments_.begin(), segments_.end(), [&](const auto& segment) {
      return segment.from <= t && t < segment.to && segment.channel.value_or(channel) == channel;
    });
  }

 private:
  std::map<Channel, std::map<TaiTime, bool>> is_out_;  ///< Excluded or not, by start time.
  std::vector<ExcludeSegment<Channel>> segments_;
};

}  // namespace spindrift
