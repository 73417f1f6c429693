/// @file
/// Limits the nesting of tables and arrays in a TOML text before it is parsed.
///
/// toml++ limits the nesting of values, but not of dotted keys, and destroys a deep tree by
/// recursion.

#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace spindrift {

/// Limit on nested brackets and on the names joined by dots in a key, above any need of our
/// schemas.
inline constexpr int kDeepestNesting = 16;

/// Returns the first line, from 1, above the limit. An invalid text is scanned as far as a parser
/// would read it.
std::optional<std::uint32_t> line_nested_too_deep(std::string_view text);

}  // namespace spindrift
