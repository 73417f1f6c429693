/// @file
/// Converts rows of the archive to samples of telemetry.

#pragma once

#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Statement.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "pipelines/core/expected.h"
#include "pipelines/time/contested.h"
#include "services/telemetry/by_kind.h"
#include "services/telemetry/sample_json.h"
#include "services/telemetry/sender_names.h"

namespace spindrift {

/// @name Read a column into a member; the schema allows no other values
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

/// Returns the columns that `read_arrived` expects, in that order.
template <class Value>
std::string arrived_columns() {
  std::string columns = "arrival, t_tai_ns";
  std::apply([&](const auto&... column) { (((columns += ", ") += column.name), ...); },
             Telemetry<Value>::kColumns);
  return columns;
}

/// Returns whether a row of arrived_columns is of a sample that its run left out: only in the
/// archive a negative arrival says so.
inline bool is_row_left_out(const SQLite::Statement& row) {
  return row.getColumn(0).getInt64() < 0;
}

template <class Value>
Arrived<Value> read_arrived(SQLite::Statement& row) {
  Arrived<Value> arrived{.arrival = {std::abs(row.getColumn(0).getInt64())}, .value = {}};
  arrived.value.t = tai_from_ns(row.getColumn(1).getInt64());
  for_each_column(arrived.value, [&, column = 1](std::string_view /*name*/, auto& member) mutable {
    read_member(row.getColumn(++column), member);
  });
  return arrived;
}

/// Column of the source, after those of arrived_columns, for kinds that need it.
template <class Value>
inline constexpr std::string_view kSourceColumn = HasSender<Value> ? ", source" : "";

/// Reads the sender from a row that ends in kSourceColumn.
template <class Value>
void read_sender(const SQLite::Statement& row, SenderNames& senders, Value& value) {
  if constexpr (HasSender<Value>) {
    value.sender = senders.number_of(row.getColumn(row.getColumnCount() - 1).getString());
  }
}

/// Returns the kind as in the table `contradiction`: the last part of its topic.
template <class Value>
constexpr std::string_view contradiction_kind() {
  constexpr std::string_view kTopic = Telemetry<Value>::kTopic;
  return kTopic.substr(kTopic.rfind('/') + 1);
}

/// Reads a sample from arrival, t_tai_ns, source and value of the table `contradiction`.
template <class Value>
Arrived<Value> read_contradicting(const SQLite::Statement& row, SenderNames& senders) {
  Arrived<Value> arrived{.arrival = {row.getColumn(0).getInt64()}, .value = {}};
  arrived.value.t = tai_from_ns(row.getColumn(1).getInt64());
  arrived.value.sender = senders.number_of(row.getColumn(2).getString());
  put_json(row.getColumn(3).getString(), arrived.value);
  return arrived;
}

/// Reads the samples of a spacecraft between two times, both included, from all runs and in order
/// of time, without samples left out because their source's time was wrong. Of contradicting
/// samples the one that counts is returned; contradictions count from the run that took the sample
/// of that instant on.
template <class Value>
std::vector<Value> read_between(const SQLite::Database& database, const std::string& spacecraft_id,
                                TaiTime from, TaiTime to, SenderNames& senders) {
  const auto read = [&](const std::string& sql, const auto& value_of) {
    SQLite::Statement query{database, sql};
    query.bind(1, spacecraft_id);
    query.bind(2, tai_ns(from));
    query.bind(3, tai_ns(to));
    std::vector<Value> values;
    while (query.executeStep()) {
      values.push_back(value_of(query));
    }
    return values;
  };
  std::vector<Value> values =
      read(fmt::format("SELECT {}{} FROM {} WHERE spacecraft_id = ?1 AND t_tai_ns BETWEEN ?2 AND ?3"
                       " AND arrival >= 0 ORDER BY t_tai_ns",
                       arrived_columns<Value>(), kSourceColumn<Value>, Telemetry<Value>::kTable),
           [&](SQLite::Statement& row) {
             Value value = read_arrived<Value>(row).value;
             read_sender(row, senders, value);
             return value;
           });
  if constexpr (HasSender<Value>) {
    const std::vector<Value> contradicting = read(
        fmt::format("SELECT c.arrival, c.t_tai_ns, c.source, c.value FROM contradiction AS c"
                    " JOIN {} AS there USING (spacecraft_id, t_tai_ns) JOIN run USING (run_id)"
                    " WHERE c.spacecraft_id = ?1 AND c.t_tai_ns BETWEEN ?2 AND ?3 AND c.kind = '{}'"
                    " AND c.arrival IS NOT NULL AND there.arrival >= 0 AND run.first_arrival >="
                    "  (SELECT max(first_arrival) FROM run WHERE spacecraft_id = ?1"
                    "   AND first_arrival <= there.arrival)"
                    " ORDER BY c.t_tai_ns, c.arrival",
                    Telemetry<Value>::kTable, contradiction_kind<Value>()),
        [&](SQLite::Statement& row) { return read_contradicting<Value>(row, senders).value; });
    const auto middle = static_cast<std::ptrdiff_t>(values.size());
    values.insert(values.end(), contradicting.begin(), contradicting.end());
    std::inplace_merge(values.begin(), values.begin() + middle, values.end(),
                       [](const Value& a, const Value& b) { return a.t < b.t; });
    return those_that_count(values, [](const auto& /*said*/, const auto& /*used*/) {});
  }
  return values;
}

/// Reads the samples of all kinds as read_between does, each kind in order of time.
/// @param preferred_source Empty when there is none.
/// @return Errors as open_for_reading; Unavailable when reading fails.
Expected<PlacedValues> find_telemetry(const std::filesystem::path& archive,
                                      const std::string& spacecraft_id,
                                      const std::string& preferred_source, TaiTime from,
                                      TaiTime to);

}  // namespace spindrift
