/// @file
/// Checks one value of a configuration file against the rule of its key.

#pragma once

#include <toml++/toml.h>

#include <optional>
#include <string>

#include "services/mission/scalar.h"
#include "services/mission/schema.h"

namespace spindrift {

/// Describes the rule for people: "a number in (0, 90) deg".
std::string allowed_by(const KeyRule& rule);

/// Returns the value for people, as written in the file, shortened.
std::string shown(const toml::node& value);

/// Returns what is wrong, worded to follow the value ("must lie in (0, 90) deg"), or empty.
std::optional<std::string> objection(const KeyRule& rule, const toml::node& value);

/// Converts `value` to the type, also an integer to a number; empty when it has another type.
std::optional<Scalar> typed(ValueType type, const toml::node& value);

/// Converts a valid `value`, an integer to a number if the rule requires one, an array to its
/// elements row by row.
Scalar value_by(const KeyRule& rule, const toml::node& value);

/// Returns an integer or number as a number.
double as_number(const Scalar& number);

/// Formats an integer or number for people.
std::string text_of(const Scalar& number);

/// Compare integers and numbers by a <= b and a < b; two integers are compared exactly.
bool at_most(const Scalar& a, const Scalar& b);
bool below(const Scalar& a, const Scalar& b);

}  // namespace spindrift
