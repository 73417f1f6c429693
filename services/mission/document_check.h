/// @file
/// Checks a whole configuration file against its schema and reports every problem.

#pragma once

#include <toml++/toml.h>

#include <cstdint>
#include <string>
#include <vector>

#include "services/mission/scalar.h"
#include "services/mission/schema.h"

namespace spindrift {

struct TomlProblem {
  std::uint32_t line;  ///< From 1; 0 when no line is known.
  std::string text;    ///< Key, value and what is allowed.
};

struct CheckedToml {
  TomlValues values;  ///< Only the valid ones.
  std::vector<TomlProblem> problems;
};

CheckedToml check_document(const TableRule& schema, const toml::table& document);

}  // namespace spindrift
