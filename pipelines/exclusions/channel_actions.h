/// @file
/// The operator actions that exclude channels and time segments of telemetry.

#pragma once

#include <optional>

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

}  // namespace spindrift
