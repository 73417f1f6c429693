/// @file
/// What operators' actions may name of each spacecraft, by its mission file.

#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "services/mission/mission.h"
#include "services/mission/spacecraft_kind.h"

namespace spindrift {

struct Nameable {
  SpacecraftKind kind;
  std::vector<std::string_view> channels;  ///< Channels or sensors that it has.
  std::vector<std::string_view> alerts;    ///< Keys, without what they are about, that it may have.
};

/// The spacecraft that actions may name, by id.
using KnownSpacecraft = std::map<std::string, Nameable>;

KnownSpacecraft known_spacecraft(const std::vector<Mission>& missions);

}  // namespace spindrift
