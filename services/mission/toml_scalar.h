/// @file
/// Converts one value of a TOML document.

#pragma once

#include <toml++/toml.h>

#include <optional>

#include "services/mission/scalar.h"

namespace spindrift {

/// Returns empty for a table, an array, a date or a time.
std::optional<Scalar> scalar_from(const toml::node& node);

}  // namespace spindrift
