/// @file
/// Values put into the places of a sentence that have their names.

#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "pipelines/core/assessment.h"

namespace spindrift {

/// What is said of a code.
template <class Code>
struct Pattern {
  Code code;
  std::string_view text;
};

/// Whether each code's pattern stands at its place, so that none is missing.
template <class Code, std::size_t kCodes>
constexpr bool are_by_code(const std::array<Pattern<Code>, kCodes>& patterns) {
  for (std::size_t i = 0; i < kCodes; ++i) {
    if (static_cast<std::size_t>(patterns[i].code) != i) {
      return false;
    }
  }
  return true;
}

template <class Code, std::size_t kCodes>
std::string_view pattern_of(const std::array<Pattern<Code>, kCodes>& patterns, Code code) {
  return patterns.at(static_cast<std::size_t>(code)).text;
}

/// @param pattern Format text of {fmt}; a time `*_tai_ns` is there as UTC text, several things of a
///        kind with commas between them.
/// @param utc_decimals Of the seconds.
/// @return `pattern` itself where `values` lack one of its names: values of an archive that is not
///         as it was written.
std::string filled(std::string_view pattern, std::span<const NamedValue> values, int utc_decimals);

}  // namespace spindrift
