/// @file
/// How many samples came of spacecraft that have no mission here.

#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>

namespace spindrift {

/// By name.
using OtherSpacecraft = std::map<std::string, std::int64_t>;

inline constexpr std::size_t kMostOtherSpacecraft = 256;
inline constexpr const char* kStillMoreSpacecraft = "(others)";

/// Where those of `spacecraft` are counted: beyond kMostOtherSpacecraft together, under
/// kStillMoreSpacecraft.
inline OtherSpacecraft::value_type& entry_of(OtherSpacecraft& others,
                                             const std::string& spacecraft) {
  const bool room = others.size() < kMostOtherSpacecraft || others.contains(spacecraft);
  return *others.try_emplace(room ? spacecraft : kStillMoreSpacecraft).first;
}

}  // namespace spindrift
