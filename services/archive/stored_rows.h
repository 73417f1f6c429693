/// @file
/// Samples of telemetry out of rows of the archive.

#pragma once

#include <SQLiteCpp/Statement.h>

#include <optional>
#include <string>
#include <string_view>
#include <tuple>

#include "services/telemetry/by_kind.h"

namespace spindrift {

/// @name A column into a member; the schema allows no other values
/// @{
inline void read_member(const SQLite::Column& column, double& member) {
  member = column.getDouble();
}
inline void read_member(const SQLite::Column& column, std::optional<double>& member) {
  member = column.isNull() ? std::nullopt : std::optional{column.getDouble()};
}
inline void read_member(const SQLite::Column& column, PulseChannel& member) {
  member = pulse_channel_from(column.getText()).value();
}
/// @}

/// For `read_arrived`, in their order.
template <class Value>
std::string arrived_columns() {
  std::string columns = "arrival, t_tai_ns";
  std::apply([&](const auto&... column) { (((columns += ", ") += column.name), ...); },
             Telemetry<Value>::kColumns);
  return columns;
}

template <class Value>
Arrived<Value> read_arrived(SQLite::Statement& row) {
  Arrived<Value> arrived{.arrival = row.getColumn(0).getInt64(), .value = {}};
  arrived.value.t = tai_from_ns(row.getColumn(1).getInt64());
  for_each_column(arrived.value, [&, column = 1](std::string_view /*name*/, auto& member) mutable {
    read_member(row.getColumn(++column), member);
  });
  return arrived;
}

}  // namespace spindrift
