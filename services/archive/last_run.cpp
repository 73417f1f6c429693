#include "services/archive/last_run.h"

#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Statement.h>

#include "services/archive/connection.h"

namespace spindrift {

Expected<std::optional<LastRun>> find_last_run(const std::filesystem::path& archive,
                                               const std::string& spacecraft_id,
                                               const std::string& mode) {
  return read_archive(archive, [&](SQLite::Database& database) -> std::optional<LastRun> {
    SQLite::Statement query{
        database,
        "SELECT run_id, telemetry, software_version, config_sha256, orbit_sha256 FROM run"
        " WHERE spacecraft_id = ? AND mode = ? ORDER BY first_arrival DESC, started_utc DESC"
        " LIMIT 1"};
    query.bind(1, spacecraft_id);
    query.bind(2, mode);
    if (!query.executeStep()) {
      return std::nullopt;
    }
    const SQLite::Column orbit = query.getColumn(4);
    return LastRun{
        .run_id = query.getColumn(0).getString(),
        .telemetry = query.getColumn(1).getString(),
        .software_version = query.getColumn(2).getString(),
        .config_sha256 = query.getColumn(3).getString(),
        .orbit_sha256 = orbit.isNull() ? std::nullopt : std::optional{orbit.getString()}};
  });
}

}  // namespace spindrift
