/// @file
/// A whole configuration file against its schema: every problem at once.

#pragma once

#include <toml++/toml.h>

#include <cstdint>
#include <string>
#include <vector>

#include "services/mission/scalar.h"
#include "services/mission/schema.h"

namespace spindrift {

struct TomlProblem {
  std::uint32_t line;  ///< From 1; 0 where no line is to blame.
  std::string text;    ///< Key, value and what is allowed.
};

struct CheckedToml {
  TomlValues values;  ///< Only the good ones.
  std::vector<TomlProblem> problems;
};

CheckedToml check_document(const TableRule& schema, const toml::table& document);

}  // namespace spindrift
