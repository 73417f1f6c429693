/// @file
/// Channels whose edges swing about where they are expected: more noise than stated, or nutation,
/// under which the axis that slits and beams see circles the one that stays. A gate that keeps half
/// of a swing keeps a side of it. An edge that lies to one side for long swings not: the axis, or
/// the sensor, is elsewhere.

#pragma once

#include <array>
#include <deque>

#include "pipelines/spin/sequential/spin_filter.h"
#include "pipelines/spin/types/pulse.h"

namespace spindrift {

class UnsteadyChannels {
 public:
  /// Of one revolution.
  void note(const EdgeTally& tally);

  /// Of the recent edges of each channel, by their quartiles, which take no notice of single
  /// spurious ones; 1 where they do not swing, or not significantly.
  const ChannelNoise& noise() const { return noise_; }

 private:
  std::array<std::deque<double>, kPulseChannels> recent_;  ///< Innovations, normalised.
  std::array<int, kPulseChannels> stale_ = {};             ///< Edges since it was found.
  ChannelNoise noise_ = kStatedNoise;
};

}  // namespace spindrift
