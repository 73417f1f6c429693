/// @file
/// Valid names of spacecraft, in files, on the bus and in the archive.

#pragma once

#include <algorithm>
#include <cstddef>
#include <string_view>

namespace spindrift {

inline constexpr std::size_t kSpacecraftIdMaxBytes = 32;  ///< As string<32> in the IDL.
inline constexpr std::string_view kSpacecraftIdAllowed =
    "1 to 32 printable ASCII characters, no comma, no space at an end";

constexpr bool is_spacecraft_id(std::string_view id) {
  const auto allowed = [](char c) { return c >= ' ' && c <= '~' && c != ','; };
  return !id.empty() && id.size() <= kSpacecraftIdMaxBytes && id.front() != ' ' &&
         id.back() != ' ' && std::all_of(id.begin(), id.end(), allowed);
}

}  // namespace spindrift
