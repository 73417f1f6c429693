/// @file
/// The rules of a configuration file, read from a file in schemas/ whose head explains them.

#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pipelines/core/expected.h"
#include "services/mission/scalar.h"

namespace spindrift {

enum class ValueType { Text, Boolean, Integer, Number };

enum class ValueForm { SpacecraftId, UnitQuaternion, Inertia, Utc };

/// One end of a range.
struct Bound {
  Scalar value;
  bool inclusive;
};

struct KeyRule {
  ValueType type;
  std::vector<std::size_t> shape;  ///< Empty for one value; a size of 0 is any.
  std::string unit;
  std::string about;
  std::optional<Scalar> default_value;
  bool optional;
  std::optional<Bound> lower;  ///< Both bounds are set for numbers.
  std::optional<Bound> upper;
  std::vector<std::string> not_below_keys;
  std::vector<std::string> one_of;
  std::optional<ValueForm> form;
};

struct TableRule {
  std::string about;
  std::string required;  ///< Empty, "always", or a spacecraft.kind.
  bool many = false;     ///< Whether it is an array of tables.
  std::vector<std::string> exactly_one_of;
  /// Keys that no longer stand here, and where they went.
  std::map<std::string, std::string, std::less<>> moved;
  std::map<std::string, KeyRule, std::less<>> keys;
  std::map<std::string, TableRule, std::less<>> tables;
};

/// @return InvalidConfiguration for an unknown property or an incomplete rule.
Expected<TableRule> parse_schema(std::string_view text);

}  // namespace spindrift
