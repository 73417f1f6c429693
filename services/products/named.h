/// @file
/// Values of enumerations from their names.

#pragma once

#include <string_view>

namespace spindrift {

/// The value of an enumeration whose name_of is `name`; `last` where none before it is, for the
/// schema allows no other names.
template <class Value>
Value named(std::string_view name, Value last) {
  int value = 0;
  while (value < static_cast<int>(last) && name_of(static_cast<Value>(value)) != name) {
    ++value;
  }
  return static_cast<Value>(value);
}

}  // namespace spindrift
