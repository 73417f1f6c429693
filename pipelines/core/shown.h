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

/// Returns whether a text from a person is shown as it is.
inline bool is_plain(std::string_view text) { return shown(text) == text; }
/// What a text from a person must be.
inline constexpr std::string_view kPlainText =
    "must be at most 200 characters, none of them a control character";
static_assert(kMostShown == 200, "kPlainText states it");

}  // namespace spindrift
