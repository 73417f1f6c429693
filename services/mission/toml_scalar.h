/// @file
/// One value of a TOML document as ours.

#pragma once

#include <toml++/toml.h>

#include <optional>

#include "services/mission/scalar.h"

namespace spindrift {

/// Empty for a table, an array, a date or a time.
std::optional<Scalar> scalar_from(const toml::node& node);

}  // namespace spindrift
