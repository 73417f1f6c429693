/// @file
/// Coded frames as a kind of telemetry.

#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <string>
#include <string_view>
#include <tuple>

#include "pipelines/spin/types/coded_frame.h"
#include "pipelines/spin/types/spin_rate.h"
#include "services/telemetry/plausible.h"
#include "services/telemetry/telemetry.h"

namespace spindrift {

/// Returns an accessor of the interval of `channel` in a frame.
constexpr auto delay_of(PulseChannel channel) {
  return [channel](auto& frame) -> auto& { return frame.delay_s[index_of(channel)]; };
}

template <>
struct Telemetry<CodedFrame> {
  static constexpr std::string_view kName = "coded";
  static constexpr std::string_view kPlural = "coded frames";
  static constexpr const char* kTopic = "spindrift/coded_frame";
  static constexpr BusMessage kMessage = BusMessage::CodedFrame;
  static constexpr std::string_view kTable = "coded_frame";
  static constexpr std::string_view kSensor = "spin.sun_sensor";
  static constexpr std::tuple kColumns{
      Column{"period_s", [](auto& frame) -> decltype(auto) { return (frame.period_s); }},
      Column{"sun2_s", delay_of(PulseChannel::Sun2)},
      Column{"north_in_s", delay_of(PulseChannel::NorthIn)},
      Column{"north_out_s", delay_of(PulseChannel::NorthOut)},
      Column{"south_in_s", delay_of(PulseChannel::SouthIn)},
      Column{"south_out_s", delay_of(PulseChannel::SouthOut)}};

  static std::string likely_ms(double value_s, double longest_s) {
    return likely_unit(value_s > longest_s && 1e-3 * value_s <= longest_s, "ms");
  }

  /// A period must lie in (0, 60] s, a delay in [0, 2] periods, or in [0, 60] s without a period.
  static std::string why_impossible(const CodedFrame& frame) {
    // The conditions are written so that NaN fails.
    if (frame.period_s && !(*frame.period_s > 0.0 && *frame.period_s <= kLongestPeriod_s)) {
      return fmt::format("period_s = {}: must be above 0, at most {} s{}", *frame.period_s,
                         kLongestPeriod_s, likely_ms(*frame.period_s, kLongestPeriod_s));
    }
    const double longest_s =
        frame.period_s ? *frame.period_s * kLongestDelay_periods : kLongestPeriod_s;
    for (std::size_t channel = 0; channel < kPulseChannels; ++channel) {
      const auto& delay_s = frame.delay_s.at(channel);
      if (delay_s && !(*delay_s >= 0.0 && *delay_s <= longest_s)) {
        return fmt::format("{}_s = {}: must be 0 to {}{}", kPulseChannelNames.at(channel), *delay_s,
                           frame.period_s ? fmt::format("two periods, {} s", longest_s)
                                          : fmt::format("{} s", kLongestPeriod_s),
                           likely_ms(*delay_s, longest_s));
      }
    }
    return {};
  }
};

}  // namespace spindrift
