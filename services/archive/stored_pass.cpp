#include "services/archive/stored_pass.h"

#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Statement.h>
#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "services/archive/connection.h"
#include "services/archive/stored_rows.h"

namespace spindrift {
namespace {

std::optional<TaiTime> time_of(const SQLite::Column& column) {
  return column.isNull() ? std::nullopt : std::optional{tai_from_ns(column.getInt64())};
}

constexpr const char* kFindRuns =
    "SELECT run_id, first_arrival, first_tai_ns, next_arrival, ifnull("
    // Each of these tables is filled in order, but one may be behind the others (detail_lane.h).
    " min((SELECT t_tai_ns FROM revolution AS last WHERE last.run_id = same.run_id"
    "   ORDER BY revolution DESC LIMIT 1),"
    "  (SELECT t_tai_ns FROM revolution AS last WHERE last.run_id = same.run_id AND revolution <="
    "   (SELECT max(revolution) FROM spin_measurement AS one WHERE one.run_id = same.run_id)"
    "   ORDER BY revolution DESC LIMIT 1),"
    // An edge without a revolution may have any time, so it does not count.
    "  (SELECT t_tai_ns FROM pulse_use AS one WHERE one.run_id = same.run_id"
    "   AND revolution IS NOT NULL ORDER BY t_tai_ns DESC LIMIT 1)),"
    // A three-axis pass writes everything else in the same lane as this.
    "  (SELECT t_tai_ns FROM attitude AS last WHERE last.run_id = same.run_id AND source = 'mekf'"
    "   ORDER BY t_tai_ns DESC LIMIT 1)),"
    " (SELECT ifnull(sum(samples), 0) FROM rejected_input WHERE rejected_input.run_id = "
    "same.run_id)"
    " FROM (SELECT *, lead(run_id) OVER (ORDER BY first_arrival) AS next_same"
    "  FROM (SELECT *, lead(first_arrival) OVER (ORDER BY first_arrival) AS next_arrival"
    "   FROM run WHERE spacecraft_id = ?) AS run WHERE mode = ? AND software_version = ?"
    "  AND config_sha256 = ? AND orbit_sha256 IS ?"
    "  AND ? = (SELECT group_concat(telemetry, char(10)) FROM (SELECT telemetry FROM run_telemetry"
    "   WHERE run_telemetry.run_id = run.run_id ORDER BY position))) AS same"
    " WHERE finished_utc IS NULL OR next_same IS NULL ORDER BY first_arrival";

std::vector<StoredPass> find_runs(const SQLite::Database& database,
                                  const std::string& spacecraft_id, const RunStart& start) {
  SQLite::Statement query{database, kFindRuns};
  query.bind(1, spacecraft_id);
  query.bind(2, std::string{name_of(start.mode)});
  query.bind(3, start.software_version);
  query.bind(4, start.config_sha256);
  if (start.orbit_sha256) {
    query.bind(5, *start.orbit_sha256);
  }
  query.bind(6, fmt::format("{}", fmt::join(start.telemetry, "\n")));
  std::vector<StoredPass> runs;
  while (query.executeStep()) {
    const SQLite::Column next_arrival = query.getColumn(3);
    runs.push_back({.run_id = query.getColumn(0).getString(),
                    .first_arrival = {query.getColumn(1).getInt64()},
                    .next_arrival = next_arrival.isNull()
                                        ? std::nullopt
                                        : std::optional<RunPlace>{{next_arrival.getInt64()}},
                    .earliest = time_of(query.getColumn(2)),
                    .last_made = time_of(query.getColumn(4)),
                    .rejected_inputs = query.getColumn(5).getInt64(),
                    .source_counts = {}});
  }
  return runs;
}

void read_source_counts(const SQLite::Database& database, StoredPass& pass) {
  SQLite::Statement query{
      database,
      "SELECT source, received, gaps, duplicates, disordered FROM source_count WHERE run_id = ?"};
  query.bind(1, pass.run_id);
  while (query.executeStep()) {
    pass.source_counts.push_back({.source = query.getColumn(0).getString(),
                                  .received = query.getColumn(1).getInt64(),
                                  .gaps = query.getColumn(2).getInt64(),
                                  .duplicates = query.getColumn(3).getInt64(),
                                  .disordered = query.getColumn(4).getInt64()});
  }
}

void read_silences(const SQLite::Database& database, StoredPass& pass) {
  SQLite::Statement query{database,
                          "SELECT arrival FROM stream_silence WHERE run_id = ? ORDER BY arrival"};
  query.bind(1, pass.run_id);
  while (query.executeStep()) {
    pass.silences.push_back({query.getColumn(0).getInt64()});
  }
}

void read_clock(const SQLite::Database& database, StoredPass& pass) {
  SQLite::Statement query{database,
                          "SELECT source, session FROM source_clock WHERE run_id = ?"
                          " ORDER BY arrival DESC LIMIT 1"};
  query.bind(1, pass.run_id);
  if (query.executeStep() && !query.getColumn(0).isNull()) {
    pass.clock = Origin{.source = query.getColumn(0).getString(),
                        .session = static_cast<std::uint64_t>(query.getColumn(1).getInt64()),
                        .seq = 0};
  }
}

void read_batches(const SQLite::Database& database, StoredPass& pass) {
  SQLite::Statement query{database,
                          "SELECT t_tai_ns FROM spin_batch WHERE run_id = ? ORDER BY t_tai_ns"};
  query.bind(1, pass.run_id);
  while (query.executeStep()) {
    pass.batches.push_back(tai_from_ns(query.getColumn(0).getInt64()));
  }
}

void read_reconstructed(const SQLite::Database& database, StoredPass& pass) {
  SQLite::Statement query{database, "SELECT method, samples FROM reconstruction WHERE run_id = ?"};
  query.bind(1, pass.run_id);
  while (query.executeStep()) {
    pass.reconstructed.emplace(query.getColumn(0).getString(), query.getColumn(1).getInt64());
  }
}

constexpr const char* kExtent =
    " WHERE spacecraft_id = ?1 AND t_tai_ns >= ?2 AND arrival >= ?3"
    " AND (?4 IS NULL OR arrival < ?4)";

void bind_extent(SQLite::Statement& query, const std::string& spacecraft_id,
                 const StoredPass& pass) {
  query.bind(1, spacecraft_id);
  query.bind(2, tai_ns(*pass.earliest));
  query.bind(3, pass.first_arrival.number);
  if (pass.next_arrival) {
    query.bind(4, pass.next_arrival->number);
  }
}

template <class Value>
void read_contradicting(const SQLite::Database& database, SenderNames& senders, StoredPass& pass) {
  SQLite::Statement query{database,
                          "SELECT arrival, t_tai_ns, source, value FROM contradiction"
                          " WHERE run_id = ? AND kind = ? AND arrival IS NOT NULL"};
  query.bind(1, pass.run_id);
  query.bind(2, std::string{contradiction_kind<Value>()});
  while (query.executeStep()) {
    pass.values.of<Value>().push_back(read_contradicting<Value>(query, senders));
  }
}

template <class Value>
void read_values(const SQLite::Database& database, const std::string& spacecraft_id,
                 SenderNames& senders, StoredPass& pass) {
  SQLite::Statement query{
      database, fmt::format("SELECT {}{} FROM {}{}", arrived_columns<Value>(), kSourceColumn<Value>,
                            Telemetry<Value>::kTable, kExtent)};
  bind_extent(query, spacecraft_id, pass);
  auto& values = pass.values.of<Value>();
  while (query.executeStep()) {
    values.push_back(read_arrived<Value>(query));
    read_sender(query, senders, values.back().value);
  }
  if constexpr (HasSender<Value>) {
    read_contradicting<Value>(database, senders, pass);
  }
  std::sort(values.begin(), values.end(),
            [](const Arrived<Value>& a, const Arrived<Value>& b) { return a.arrival < b.arrival; });
}

LeftOut& left_out_of(StoredPass& pass, Origin origin) {
  const auto known =
      std::find_if(pass.left_out.begin(), pass.left_out.end(), [&](const LeftOut& left_out) {
        return left_out.last.source == origin.source && left_out.last.session == origin.session;
      });
  return known != pass.left_out.end()
             ? *known
             : pass.left_out.emplace_back(LeftOut{.last = std::move(origin), .values = {}});
}

/// Reads the samples left out. Stored arrivals are negative, so the query gives the latest first.
template <class Value>
void read_left_out(const SQLite::Database& database, const std::string& spacecraft_id,
                   SenderNames& senders, StoredPass& pass) {
  SQLite::Statement query{
      database, fmt::format("SELECT {}, source, session, seq FROM {} WHERE spacecraft_id = ?"
                            " AND arrival < 0 AND arrival <= ? ORDER BY arrival LIMIT ?",
                            arrived_columns<Value>(), Telemetry<Value>::kTable)};
  query.bind(1, spacecraft_id);
  query.bind(2, -pass.first_arrival.number);
  query.bind(3, StoredPass::kMostLeftOut);
  while (query.executeStep()) {
    const int source = query.getColumnCount() - 3;
    Arrived<Value> arrived = read_arrived<Value>(query);
    const auto seq = static_cast<std::uint64_t>(query.getColumn(source + 2).getInt64());
    LeftOut& left_out = left_out_of(
        pass, {.source = query.getColumn(source).getString(),
               .session = static_cast<std::uint64_t>(query.getColumn(source + 1).getInt64()),
               .seq = seq});
    left_out.last.seq = std::max(left_out.last.seq, seq);
    if constexpr (HasSender<Value>) {
      arrived.value.sender = senders.number_of(left_out.last.source);
    }
    left_out.values.of<Value>().push_back(std::move(arrived));
  }
  for (LeftOut& left_out : pass.left_out) {
    auto& values = left_out.values.of<Value>();
    std::reverse(values.begin(), values.end());
  }
}

std::vector<Origin> last_origins(const SQLite::Database& database, std::string_view table,
                                 const std::string& spacecraft_id, const StoredPass& pass) {
  SQLite::Statement query{database,
                          fmt::format("SELECT source, session, max(seq) FROM {}{} GROUP BY source,"
                                      " session",
                                      table, kExtent)};
  bind_extent(query, spacecraft_id, pass);
  std::vector<Origin> last;
  while (query.executeStep()) {
    last.push_back({.source = query.getColumn(0).getString(),
                    .session = static_cast<std::uint64_t>(query.getColumn(1).getInt64()),
                    .seq = static_cast<std::uint64_t>(query.getColumn(2).getInt64())});
  }
  return last;
}

}  // namespace

Expected<std::vector<StoredPass>> find_stored_passes(const std::filesystem::path& archive,
                                                     const std::string& spacecraft_id,
                                                     const RunStart& start, SenderNames& senders) {
  return read_archive(archive, [&](SQLite::Database& database) {
    std::vector<StoredPass> passes = find_runs(database, spacecraft_id, start);
    for (StoredPass& pass : passes) {
      read_source_counts(database, pass);
      read_silences(database, pass);
      read_clock(database, pass);
      read_batches(database, pass);
      read_reconstructed(database, pass);
      if (!pass.next_arrival) {
        TelemetryKinds::for_each([&]<class Value>(Kind<Value> /*kind*/) {
          read_left_out<Value>(database, spacecraft_id, senders, pass);
        });
      }
      if (pass.earliest) {
        TelemetryKinds::for_each([&]<class Value>(Kind<Value> /*kind*/) {
          read_values<Value>(database, spacecraft_id, senders, pass);
          pass.last_origins[kTelemetryKind<Value>] =
              last_origins(database, Telemetry<Value>::kTable, spacecraft_id, pass);
        });
      }
    }
    return passes;
  });
}

Expected<std::int64_t> count_stored_edges(const std::filesystem::path& archive,
                                          const std::string& run_id) {
  return read_archive(archive, [&](SQLite::Database& database) {
    SQLite::Statement query{
        database,
        "WITH extent AS (SELECT spacecraft_id, first_tai_ns, first_arrival, ifnull("
        "  (SELECT min(later.first_arrival) FROM run AS later WHERE later.spacecraft_id ="
        "   run.spacecraft_id AND later.first_arrival > run.first_arrival), 9223372036854775807)"
        "  AS end_arrival FROM run WHERE run_id = ?)"
        " SELECT (SELECT count(*) FROM extent JOIN pulse USING (spacecraft_id)"
        "   WHERE t_tai_ns >= first_tai_ns AND arrival >= first_arrival AND arrival < end_arrival)"
        "  + (SELECT ifnull(sum(1 + (sun2_s IS NOT NULL) + (north_in_s IS NOT NULL)"
        "    + (north_out_s IS NOT NULL) + (south_in_s IS NOT NULL) + (south_out_s IS NOT NULL)), "
        "0)"
        "   FROM extent JOIN coded_frame USING (spacecraft_id)"
        "   WHERE t_tai_ns >= first_tai_ns AND arrival >= first_arrival AND arrival < "
        "end_arrival)"};
    query.bind(1, run_id);
    query.executeStep();
    return query.getColumn(0).getInt64();
  });
}

}  // namespace spindrift
