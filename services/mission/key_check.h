/// @file
/// One value of a configuration file against the rule of its key.

#pragma once

#include <toml++/toml.h>

#include <optional>
#include <string>

#include "services/mission/scalar.h"
#include "services/mission/schema.h"

namespace spindrift {

/// For people: "a number in (0, 90) deg".
std::string allowed_by(const KeyRule& rule);

/// For people: the value as it would stand in the file, shortened.
std::string shown(const toml::node& value);

/// What is wrong with `value`, worded to follow it ("must lie in (0, 90) deg"); empty when nothing.
std::optional<std::string> objection(const KeyRule& rule, const toml::node& value);

/// `value` as the type of the rule, an integer becoming a number; empty if it has another type.
std::optional<Scalar> typed(ValueType type, const toml::node& value);

/// `value`, against which there is no objection; an integer becomes a number where the rule asks
/// for one, an array stands row by row.
Scalar value_by(const KeyRule& rule, const toml::node& value);

/// For people: an integer or a number.
std::string text_of(const Scalar& number);

/// a <= b and a < b of integers and numbers; two integers are compared exactly.
bool at_most(const Scalar& a, const Scalar& b);
bool below(const Scalar& a, const Scalar& b);

}  // namespace spindrift
