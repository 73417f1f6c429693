/// @file
/// Makes text from outside safe for messages, logs and archive keys.

#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace spindrift {

inline constexpr std::size_t kMostShown = 200;  ///< Longest text that is shown, characters.

/// Returns `text`, which may be invalid UTF-8, with control characters, line separators,
/// bidirectional marks and invalid bytes replaced by \xNN. Longer text is cut after kMostShown
/// characters, with "..." for the rest.
std::string shown(std::string_view text);

}  // namespace spindrift
