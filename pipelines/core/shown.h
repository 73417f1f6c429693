/// @file
/// Text from outside, as a message, a log or a key of the archive may hold it.

#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace spindrift {

inline constexpr std::size_t kMostShown = 200;  ///< Characters.

/// `text` of unknown origin, UTF-8 or not. Control characters, line separators, marks that turn the
/// direction of writing, and bytes that are no UTF-8 become \xNN; beyond kMostShown characters
/// "..." stands for the rest.
std::string shown(std::string_view text);

}  // namespace spindrift
