#include "services/archive/last_run.h"

#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Statement.h>

#include "services/archive/connection.h"

namespace spindrift {
namespace {

std::vector<std::string> telemetry_of(const SQLite::Database& database, const std::string& run_id) {
  SQLite::Statement query{database,
                          "SELECT telemetry FROM run_telemetry WHERE run_id = ? ORDER BY position"};
  query.bind(1, run_id);
  std::vector<std::string> telemetry;
  while (query.executeStep()) {
    telemetry.push_back(query.getColumn(0).getString());
  }
  return telemetry;
}

}  // namespace

Expected<std::optional<LastRun>> find_last_run(const std::filesystem::path& archive,
                                               const std::string& spacecraft_id, RunMode mode) {
  return read_archive(archive, [&](SQLite::Database& database) -> std::optional<LastRun> {
    SQLite::Statement query{
        database,
        "SELECT run_id, software_version, config_sha256, orbit_sha256, first_tai_ns, last_tai_ns "
        "FROM run"
        " WHERE spacecraft_id = ? AND mode = ? ORDER BY first_arrival DESC, started_utc DESC"
        " LIMIT 1"};
    query.bind(1, spacecraft_id);
    query.bind(2, std::string{name_of(mode)});
    if (!query.executeStep()) {
      return std::nullopt;
    }
    const std::string run_id = query.getColumn(0).getString();
    const SQLite::Column orbit = query.getColumn(3);
    const auto time_in = [&](int column) {
      const SQLite::Column t = query.getColumn(column);
      return t.isNull() ? std::nullopt : std::optional{tai_from_ns(t.getInt64())};
    };
    return LastRun{.run_id = run_id,
                   .telemetry = telemetry_of(database, run_id),
                   .software_version = query.getColumn(1).getString(),
                   .config_sha256 = query.getColumn(2).getString(),
                   .orbit_sha256 = orbit.isNull() ? std::nullopt : std::optional{orbit.getString()},
                   .first_sample = time_in(4),
                   .last_sample = time_in(5)};
  });
}

Expected<std::optional<RunPlace>> find_last_first_arrival(const std::filesystem::path& archive,
                                                          const std::string& spacecraft_id) {
  return read_archive(archive, [&](SQLite::Database& database) -> std::optional<RunPlace> {
    SQLite::Statement query{database, "SELECT max(first_arrival) FROM run WHERE spacecraft_id = ?"};
    query.bind(1, spacecraft_id);
    query.executeStep();
    const SQLite::Column last = query.getColumn(0);
    return last.isNull() ? std::nullopt : std::optional<RunPlace>{{last.getInt64()}};
  });
}

}  // namespace spindrift
