/// @file
/// Counts samples of spacecraft that have no mission here.

#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>

namespace spindrift {

/// Sample counts by spacecraft name.
using OtherSpacecraft = std::map<std::string, std::int64_t>;

inline constexpr std::size_t kMostOtherSpacecraft = 256;
inline constexpr const char* kStillMoreSpacecraft = "(others)";

/// Returns the count for `spacecraft`. Those beyond kMostOtherSpacecraft share the entry
/// kStillMoreSpacecraft.
inline OtherSpacecraft::value_type& entry_of(OtherSpacecraft& others,
                                             const std::string& spacecraft) {
  const bool room = others.size() < kMostOtherSpacecraft || others.contains(spacecraft);
  return *others.try_emplace(room ? spacecraft : kStillMoreSpacecraft).first;
}

}  // namespace spindrift
