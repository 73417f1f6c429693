/// @file
/// Access to the values of a valid configuration file.

#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "pipelines/frames/angle.h"
#include "services/mission/scalar.h"

namespace spindrift {

/// Returns the value of a key; empty where the key is absent. `T` is its type in the schema.
template <class T>
std::optional<T> value_if(const TomlValues& values, std::string_view key) {
  const auto found = values.find(key);
  return found == values.end() ? std::nullopt : std::optional{std::get<T>(found->second)};
}

/// Returns the value of a key that is required or has a default.
template <class T>
T value_of(const TomlValues& values, std::string_view key) {
  return std::get<T>(values.find(key)->second);
}

inline double number(const TomlValues& values, std::string_view key) {
  return value_of<double>(values, key);
}

inline constexpr double kArcsecPerDeg = 3600.0;

/// Converts the value of a key in degrees.
inline double radians(const TomlValues& values, std::string_view key) {
  return number(values, key) * kRadPerDeg;
}

/// Converts the value of a key in degrees; empty where the key is absent.
inline std::optional<double> radians_if(const TomlValues& values, std::string_view key) {
  return values.contains(key) ? std::optional{radians(values, key)} : std::nullopt;
}

}  // namespace spindrift
