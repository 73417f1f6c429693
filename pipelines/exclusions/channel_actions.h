/// @file
/// Channels and spans of time that an operator leaves out.

#pragma once

#include <optional>

#include "pipelines/time/tai_time.h"

namespace spindrift {

/// @tparam Channel What a spacecraft of the kind has several of.
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
  TaiTime to;                      ///< Itself not in it.
  std::optional<Channel> channel;  ///< Empty: all.
};

}  // namespace spindrift
