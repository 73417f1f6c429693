/// @file
/// The share of edges that the filter's gate leaves out, of all and of each channel: whether they
/// lie where they are predicted.

#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "pipelines/spin/sequential/spin_filter.h"
#include "pipelines/spin/types/pulse.h"

namespace spindrift {

class GatingMonitor {
 public:
  /// Of one revolution.
  void note(const EdgeStatistics& tally);

  /// Of the recent edges.
  bool most_gated() const;
  /// A third of the recent or of the first edges: some accepted ones are likely wrong too.
  bool many_gated() const;
  /// The channel most of whose edges of the recent revolutions are gated.
  std::optional<PulseChannel> channel_mostly_gated() const;

  std::int64_t revolutions() const { return revolutions_; }
  std::int64_t gated() const { return gated_; }  ///< Edges.

 private:
  std::int64_t revolutions_ = 0;
  std::int64_t gated_ = 0;
  double edges_ = 0.0;
  double share_ = 0.0;
  double share_from_the_start_ = 0.0;
  std::array<double, kPulseChannels> channel_share_ = {};
};

}  // namespace spindrift
