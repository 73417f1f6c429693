/// @file
/// A whole mission file against the schema: every problem at once.

#pragma once

#include <toml++/toml.h>

#include <cstdint>
#include <string>
#include <vector>

#include "services/mission/mission_schema.h"
#include "services/mission/scalar.h"

namespace spindrift {

struct MissionProblem {
  std::uint32_t line;  ///< From 1; 0 where no line is to blame.
  std::string text;    ///< Key, value and what is allowed.
};

struct CheckedMission {
  MissionValues values;  ///< Only the good ones.
  std::vector<MissionProblem> problems;
};

CheckedMission check_mission(const TableRule& schema, const toml::table& document);

}  // namespace spindrift
