/// @file
/// The raw datum of a spin-stabilised satellite: the leading edge of a sensor pulse.

#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <optional>
#include <string_view>

#include "pipelines/observation/observation.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

enum class PulseChannel { Sun1, Sun2, NorthIn, NorthOut, SouthIn, SouthOut };
inline constexpr std::size_t kPulseChannels = 6;

/// The names of the channels in files and in the archive, by value of PulseChannel.
inline constexpr std::array<std::string_view, kPulseChannels> kPulseChannelNames = {
    "sun1", "sun2", "north_in", "north_out", "south_in", "south_out"};

constexpr std::size_t index_of(PulseChannel channel) { return static_cast<std::size_t>(channel); }
constexpr bool sees_the_sun(PulseChannel channel) {
  return channel == PulseChannel::Sun1 || channel == PulseChannel::Sun2;
}
constexpr std::string_view name_of(PulseChannel channel) {
  return kPulseChannelNames.at(index_of(channel));
}
constexpr SampleSource source_of(PulseChannel channel) {
  return static_cast<SampleSource>(index_of(channel));
}
constexpr PulseChannel channel_of(SampleSource source) {
  return static_cast<PulseChannel>(index_of(source));
}
std::optional<PulseChannel> pulse_channel_from(std::string_view name);

/// A leading edge; edges are ordered by time, then channel, and processed so in every mode.
struct Pulse {
  TaiTime t;
  PulseChannel channel;
  friend constexpr auto operator<=>(const Pulse&, const Pulse&) = default;
};

}  // namespace spindrift
