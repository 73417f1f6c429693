/// @file
/// Fills named placeholders of a sentence with values.

#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "pipelines/core/assessment.h"

namespace spindrift {

/// Sentence pattern of a code.
template <class Code>
struct Pattern {
  Code code;
  std::string_view text;
};

/// Checks at compile time that every code has its pattern, in the order of the codes.
template <class OfCode, std::size_t kCodes>
constexpr bool are_by_code(const std::array<OfCode, kCodes>& patterns) {
  for (std::size_t i = 0; i < kCodes; ++i) {
    if (static_cast<std::size_t>(patterns[i].code) != i) {
      return false;
    }
  }
  return true;
}

template <class OfCode, std::size_t kCodes, class Code>
std::string_view pattern_of(const std::array<OfCode, kCodes>& patterns, Code code) {
  return patterns.at(static_cast<std::size_t>(code)).text;
}

/// @param pattern Format text of {fmt}. A time `*_tai_ns` is inserted as UTC text, several values
///        of one name with commas between them.
/// @param utc_decimals Decimals of the seconds in UTC text.
/// @return `pattern` itself when `values` lack one of its names, as in a modified archive.
std::string filled(std::string_view pattern, std::span<const NamedValue> values, int utc_decimals);

}  // namespace spindrift
