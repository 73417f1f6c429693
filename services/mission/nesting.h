/// @file
/// How deep tables and arrays of a TOML text stand in each other, before anything is made of it.

#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace spindrift {

/// Of brackets in each other, and of the names that dots join in one key: more than any schema of
/// ours needs.
inline constexpr int kDeepestNesting = 16;

/// The first line, from 1, with more than that. A text that is no TOML is looked at as far as a
/// parser would come.
std::optional<std::uint32_t> line_nested_too_deep(std::string_view text);

}  // namespace spindrift
