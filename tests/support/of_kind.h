/// @file
/// Picks the values of one type out of a list of variants.

#pragma once

#include <variant>
#include <vector>

namespace spindrift {

template <class Value, class Variant>
std::vector<Value> of_kind(const std::vector<Variant>& all) {
  std::vector<Value> found;
  for (const Variant& one : all) {
    if (const auto* const value = std::get_if<Value>(&one)) {
      found.push_back(*value);
    }
  }
  return found;
}

}  // namespace spindrift
