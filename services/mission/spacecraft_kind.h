/// @file
/// The kinds of spacecraft.

#pragma once

#include <array>
#include <string_view>

namespace spindrift {

enum class SpacecraftKind { Spin, ThreeAxis };

/// Returns the name in the mission file: "spin", "three_axis".
constexpr std::string_view name_of(SpacecraftKind kind) {
  constexpr std::array<std::string_view, 2> kNames = {"spin", "three_axis"};
  return kNames.at(static_cast<std::size_t>(kind));
}

}  // namespace spindrift
