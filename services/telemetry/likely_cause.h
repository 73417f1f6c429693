/// @file
/// Guesses, from what cannot be read, what its writer did.

#pragma once

#include <cstddef>
#include <string_view>

namespace spindrift {

/// @name What a refused text looks like
/// @return The end of a reason, as "; looks like ms, not ns"; empty where nothing is known.
/// @{
std::string_view likely_time(std::string_view field);
/// @param line Header or row that has not so many columns as it must.
std::string_view likely_separator(std::string_view line, std::size_t columns);
/// @}

}  // namespace spindrift
