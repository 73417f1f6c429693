/// @file
/// Columns of SQL to values of the domain, where more than one reader needs them.

#pragma once

#include <SQLiteCpp/Statement.h>

#include <Eigen/Core>
#include <numbers>
#include <string_view>

#include "pipelines/frames/celestial.h"

namespace spindrift {

inline constexpr double kRadPerDeg = std::numbers::pi / 180.0;

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

/// From the columns `ra_deg` and, behind it, `dec_deg`.
inline Eigen::Vector3d axis_of(SQLite::Statement& row, int ra_deg = 0) {
  return direction_icrf({.ra_rad = row.getColumn(ra_deg).getDouble() * kRadPerDeg,
                         .dec_rad = row.getColumn(ra_deg + 1).getDouble() * kRadPerDeg});
}

}  // namespace spindrift
