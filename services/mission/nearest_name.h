/// @file
/// The name that a misspelt one was probably meant to be.

#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace spindrift {

/// The name nearest to `given` (insert, delete, replace, swap neighbours), if at most a third of
/// its letters differ; empty otherwise.
std::string nearest_name(std::string_view given, const std::vector<std::string>& names);

}  // namespace spindrift
