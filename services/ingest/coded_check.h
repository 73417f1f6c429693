/// @file
/// What a coded frame can say, the same for files and the bus.

#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <string>

#include "pipelines/spin/types/coded_frame.h"

namespace spindrift {

/// A delay is modulo the period, but both are measured apart: noise and rounding may put a delay
/// of nearly the period just beyond it. Further than this it is none.
inline constexpr double kLongestDelay_periods = 1.01;

/// Field, value and what is allowed; empty for a frame that can be true. A period lies in
/// (0, 60] s, a delay in [0, 1.01] periods, or in [0, 60] s where there is none.
inline std::string why_impossible(const CodedFrame& frame) {
  // Written so that NaN fails.
  if (frame.period_s && !(*frame.period_s > 0.0 && *frame.period_s <= kLongestPeriod_s)) {
    return fmt::format("period_s = {}: must be above 0, at most {} s", *frame.period_s,
                       kLongestPeriod_s);
  }
  const double longest_s =
      frame.period_s ? *frame.period_s * kLongestDelay_periods : kLongestPeriod_s;
  for (std::size_t channel = 0; channel < kPulseChannels; ++channel) {
    const auto& delay_s = frame.delay_s.at(channel);
    if (delay_s && !(*delay_s >= 0.0 && *delay_s <= longest_s)) {
      return fmt::format("{}_s = {}: must be 0 to {}", kPulseChannelNames.at(channel), *delay_s,
                         frame.period_s ? fmt::format("the period, {} s", *frame.period_s)
                                        : fmt::format("{} s", kLongestPeriod_s));
    }
  }
  return {};
}

}  // namespace spindrift
