/// @file
/// The two infrared sensors, north and south, and what belongs to each.

#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "pipelines/spin/types/config.h"
#include "pipelines/spin/types/products.h"
#include "pipelines/spin/types/pulse.h"

namespace spindrift {

enum class Side { North, South };
inline constexpr std::array<Side, 2> kSides = {Side::North, Side::South};
inline constexpr std::array<SpinQuantity, 2> kChords = {SpinQuantity::NorthChord,
                                                        SpinQuantity::SouthChord};
inline constexpr std::array<SpinQuantity, 2> kDihedrals = {SpinQuantity::NorthDihedral,
                                                           SpinQuantity::SouthDihedral};
inline constexpr std::array<PulseChannel, 2> kInChannels = {PulseChannel::NorthIn,
                                                            PulseChannel::SouthIn};
inline constexpr std::array<PulseChannel, 2> kOutChannels = {PulseChannel::NorthOut,
                                                             PulseChannel::SouthOut};
constexpr std::size_t index_of(Side side) { return static_cast<std::size_t>(side); }

/// @param channel Channel of an infrared beam.
constexpr Side side_of(PulseChannel channel) {
  const bool is_north = channel == PulseChannel::NorthIn || channel == PulseChannel::NorthOut;
  return is_north ? Side::North : Side::South;
}

/// Returns whether both are the same slit or ends of the same chord.
constexpr bool are_of_one_sensor(PulseChannel one, PulseChannel other) {
  return one == other ||
         (!sees_the_sun(one) && !sees_the_sun(other) && side_of(one) == side_of(other));
}

/// The sensor of a side; empty when the mission has none.
inline const std::optional<InfraredSensor>& sensor_of(const SpinConfig& config, Side side) {
  return side == Side::North ? config.north : config.south;
}

}  // namespace spindrift
