/// @file
/// Samples of telemetry out of rows of the archive.

#pragma once

#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Statement.h>
#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "pipelines/core/expected.h"
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

/// Of a spacecraft in order of time, whatever run took them, both ends included; without those that
/// a run left out since the time of their source was wrong.
template <class Value>
std::vector<Value> read_between(const SQLite::Database& database, const std::string& spacecraft_id,
                                TaiTime from, TaiTime to) {
  SQLite::Statement query{
      database, fmt::format("SELECT {} FROM {} WHERE spacecraft_id = ? AND t_tai_ns BETWEEN ? AND ?"
                            " AND arrival >= 0 ORDER BY t_tai_ns",
                            arrived_columns<Value>(), Telemetry<Value>::kTable)};
  query.bind(1, spacecraft_id);
  query.bind(2, tai_ns(from));
  query.bind(3, tai_ns(to));
  std::vector<Value> values;
  while (query.executeStep()) {
    values.push_back(read_arrived<Value>(query).value);
  }
  return values;
}

/// All kinds likewise, arrived in order of time.
/// @return As open_for_reading; Unavailable when reading fails.
Expected<TelemetryValues> find_telemetry(const std::filesystem::path& archive,
                                         const std::string& spacecraft_id, TaiTime from,
                                         TaiTime to);

}  // namespace spindrift
