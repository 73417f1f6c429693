/// @file
/// Suggests the correct name for a misspelt one.

#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace spindrift {

/// Returns the name nearest to `given` (insert, delete, replace, swap neighbours), if at most a
/// third of its letters differ; empty otherwise.
std::string nearest_name(std::string_view given, const std::vector<std::string>& names);

}  // namespace spindrift
