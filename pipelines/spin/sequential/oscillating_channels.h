/// @file
/// Channels whose innovations oscillate about zero: more noise than stated, or nutation, under
/// which the axis that slits and beams see circles the angular momentum. A gate of fixed width
/// would keep one side of the oscillation and bias the axis. Innovations that stay on one side do
/// not oscillate: the axis, or the sensor, is elsewhere.

#pragma once

#include <array>
#include <deque>

#include "pipelines/spin/sequential/spin_filter.h"
#include "pipelines/spin/types/pulse.h"

namespace spindrift {

class OscillatingChannels {
 public:
  /// Of one revolution.
  void note(const EdgeStatistics& tally);

  /// Of the recent edges of each channel, by their quartiles, which take no notice of single
  /// spurious ones; 1 where they do not oscillate significantly.
  const ChannelNoise& noise() const { return noise_; }

 private:
  std::array<std::deque<double>, kPulseChannels> recent_;  ///< Innovations, normalised.
  std::array<int, kPulseChannels> stale_ = {};             ///< Edges since it was found.
  ChannelNoise noise_ = kStatedNoise;
};

}  // namespace spindrift
