/// @file
/// Formats a count with its noun.

#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>

namespace spindrift {

/// Returns "1 star fix", "2 star fixes". @param plural Ends in "s", with "xes" for one in "x".
template <class Count>
std::string counted(Count count, std::string_view plural) {
  if (count == 1) {
    plural.remove_suffix(plural.ends_with("xes") ? 2 : 1);
  }
  return fmt::format("{} {}", count, plural);
}

}  // namespace spindrift
