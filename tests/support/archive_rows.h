/// @file
/// Reads the rows of an archive as text that is equal exactly when the stored values are bitwise
/// equal.

#pragma once

#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Statement.h>
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "pipelines/spin/types/pulse.h"

namespace spindrift {

/// An archive is locked for a moment while another program opens or closes it.
inline constexpr int kBusy_ms = 30'000;

inline std::vector<std::string> rows_of(const std::filesystem::path& db, const std::string& query) {
  const SQLite::Database database{db.string(), SQLite::OPEN_READONLY, kBusy_ms};
  SQLite::Statement statement{database, query};
  std::vector<std::string> rows;
  while (statement.executeStep()) {
    std::string row;
    for (int i = 0; i < statement.getColumnCount(); ++i) {
      const SQLite::Column column = statement.getColumn(i);
      row += column.isFloat() ? fmt::format("{:a}", column.getDouble()) : column.getString();
      row += '|';
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

/// Returns the rows of all queries.
inline std::vector<std::string> rows_of(const std::filesystem::path& db,
                                        const std::vector<std::string>& queries) {
  std::vector<std::string> rows;
  for (const std::string& query : queries) {
    for (std::string& row : rows_of(db, query)) {
      rows.push_back(std::move(row));
    }
  }
  return rows;
}

inline std::int64_t number_of(const std::filesystem::path& db, const std::string& query) {
  SQLite::Database database{db.string(), SQLite::OPEN_READONLY, kBusy_ms};
  return database.execAndGet(query).getInt64();
}

/// @param from Table, with what joins and restricts its rows.
inline std::int64_t count_rows(const std::filesystem::path& db, const std::string& from) {
  return number_of(db, "SELECT count(*) FROM " + from);
}

inline double real_of(const std::filesystem::path& db, const std::string& query) {
  SQLite::Database database{db.string(), SQLite::OPEN_READONLY, kBusy_ms};
  return database.execAndGet(query).getDouble();
}

/// Returns the number of stored samples of three-axis telemetry before an instant. A service may be
/// killed between two halves of a pass when all samples of the first are stored.
inline std::int64_t three_axis_samples_before(const std::filesystem::path& db,
                                              std::int64_t t_tai_ns) {
  std::int64_t samples = 0;
  for (const char* const table :
       {"gyro_sample", "sun_sample", "star_sample", "magnetometer_sample", "orbit_state_sample"}) {
    samples +=
        number_of(db, fmt::format("SELECT count(*) FROM {} WHERE t_tai_ns < {}", table, t_tai_ns));
  }
  return samples;
}

/// Returns all products of all runs, without the names of the runs.
inline std::vector<std::string> product_rows(const std::filesystem::path& db) {
  return rows_of(
      db, std::vector<std::string>{
              "SELECT spacecraft_id, t_tai_ns, channel FROM pulse ORDER BY 1, 2, 3",
              "SELECT spacecraft_id, t_tai_ns, channel, revolution, accepted, rejected_by"
              " FROM pulse_use ORDER BY 1, 2, 3",
              "SELECT revolution, t_tai_ns, period_s FROM revolution ORDER BY 1",
              "SELECT revolution, quantity, value, unit, sigma, accepted, rejected_by"
              " FROM spin_measurement ORDER BY 1, 2",
              "SELECT revolution, t_tai_ns, geometry_case, ra_deg, dec_deg, sigma_deg,"
              " alternate_ra_deg, alternate_dec_deg, resolution, accepted, cov_east_east_deg2,"
              " cov_east_north_deg2, cov_north_north_deg2, norm FROM spin_fix ORDER BY 1",
              "SELECT revolution, candidate, ra_deg, dec_deg FROM spin_fix_candidate ORDER BY 1, 2",
              "SELECT t_tai_ns, estimator, ra_deg, dec_deg, sigma_deg, spin_rate_rpm, sigma_rpm,"
              " status, cov_east_east_deg2, cov_east_north_deg2, cov_north_north_deg2"
              " FROM spin_estimate WHERE estimator <> 'batch' ORDER BY 1, 2"});
}

/// Returns the rows of every table, without the columns in which two services that take the same
/// telemetry differ: names of runs and sessions, their source, wall-clock times, how often a sample
/// was sent, whose telemetry the clock was, the salt of the log, and alerts (some of which concern
/// the service itself).
inline std::vector<std::string> all_rows(const std::filesystem::path& db) {
  const SQLite::Database database{db.string(), SQLite::OPEN_READONLY, kBusy_ms};
  SQLite::Statement tables{
      database,
      "SELECT name, (SELECT group_concat(char(34) || name || char(34))"
      " FROM pragma_table_info(stored.name)"
      " WHERE name NOT IN ('run_id', 'session', 'started_utc', 'finished_utc', 'first_arrival',"
      "  'arrival', 'received', 'announced_utc'))"
      " FROM sqlite_schema AS stored WHERE type = 'table' AND name NOT LIKE 'sqlite_%'"
      " AND name NOT IN ('run_telemetry', 'stream_silence', 'source_clock', 'own_log', 'alert',"
      "  'alert_transition')"};
  std::vector<std::string> rows;
  while (tables.executeStep()) {
    const std::string table = tables.getColumn(0).getString();
    for (const std::string& row :
         rows_of(db, fmt::format("SELECT {} FROM {}", tables.getColumn(1).getString(), table))) {
      rows.push_back(fmt::format("{}|{}", table, row));
    }
  }
  std::sort(rows.begin(), rows.end());
  return rows;
}

/// Returns the last `batch` solution of a run. Earlier ones are left out because a service solves
/// once a minute besides.
inline std::vector<std::string> last_batch_rows(const std::filesystem::path& db) {
  return rows_of(
      db,
      std::vector<std::string>{
          "SELECT t_tai_ns, ra_deg, dec_deg, sigma_deg, spin_rate_rpm, sigma_rpm, status"
          " FROM spin_estimate WHERE estimator = 'batch' ORDER BY 1 DESC LIMIT 1",
          "SELECT t_tai_ns, bound_deg, consider_sigma_deg, rate_drift_rpm_h, "
          "rate_drift_sigma_rpm_h, edges, outliers, noise, iterations, changed_tai_ns"
          " FROM spin_batch ORDER BY 1 DESC LIMIT 1",
          "SELECT t_tai_ns, position, value FROM spin_batch_singular_value"
          " WHERE t_tai_ns = (SELECT max(t_tai_ns) FROM spin_batch) ORDER BY 2",
          "SELECT t_tai_ns, position, direction FROM spin_batch_undetermined"
          " WHERE t_tai_ns = (SELECT max(t_tai_ns) FROM spin_batch) ORDER BY 2",
          "SELECT t_tai_ns, detected, detectable_deg FROM spin_nutation ORDER BY 1 DESC LIMIT 1",
          "SELECT name, value, sigma, unit, observable, estimated FROM spin_bias ORDER BY 1"});
}

/// Returns all pulses in order of time.
inline std::vector<Pulse> pulses_in(const std::filesystem::path& archive) {
  const SQLite::Database database{archive.string(), SQLite::OPEN_READONLY, kBusy_ms};
  SQLite::Statement rows{database, "SELECT t_tai_ns, channel FROM pulse ORDER BY t_tai_ns"};
  std::vector<Pulse> pulses;
  while (rows.executeStep()) {
    pulses.push_back({.t = tai_from_ns(rows.getColumn(0).getInt64()),
                      .channel = pulse_channel_from(rows.getColumn(1).getText()).value()});
  }
  return pulses;
}

}  // namespace spindrift
