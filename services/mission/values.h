/// @file
/// Values of a configuration file in which no problem was found.

#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "pipelines/frames/angle.h"
#include "services/mission/scalar.h"

namespace spindrift {

/// The value of a key; empty where the key is absent. `T`: as the schema has it.
template <class T>
std::optional<T> value_if(const TomlValues& values, std::string_view key) {
  const auto found = values.find(key);
  return found == values.end() ? std::nullopt : std::optional{std::get<T>(found->second)};
}

/// The key is required or has a default.
template <class T>
T value_of(const TomlValues& values, std::string_view key) {
  return std::get<T>(values.find(key)->second);
}

inline double number(const TomlValues& values, std::string_view key) {
  return value_of<double>(values, key);
}

inline constexpr double kArcsecPerDeg = 3600.0;

/// Of a key in degrees.
inline double radians(const TomlValues& values, std::string_view key) {
  return number(values, key) * kRadPerDeg;
}

/// Likewise; empty where the key is absent.
inline std::optional<double> radians_if(const TomlValues& values, std::string_view key) {
  return values.contains(key) ? std::optional{radians(values, key)} : std::nullopt;
}

}  // namespace spindrift
