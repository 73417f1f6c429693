/// @file
/// Converts names to enumeration values.

#pragma once

#include <string_view>

namespace spindrift {

/// Returns the enumeration value whose name_of is `name`, searching before `last`; else `last`,
/// since the schema allows no other names.
template <class Value>
Value named(std::string_view name, Value last) {
  int value = 0;
  while (value < static_cast<int>(last) && name_of(static_cast<Value>(value)) != name) {
    ++value;
  }
  return static_cast<Value>(value);
}

}  // namespace spindrift
