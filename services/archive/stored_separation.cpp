#include "services/archive/stored_separation.h"

#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Statement.h>
#include <fmt/format.h>

#include <vector>

#include "pipelines/core/shown.h"
#include "pipelines/exclusions/exclusions.h"
#include "pipelines/three_axis/sample_kind.h"
#include "services/archive/connection.h"
#include "services/archive/stored_pass.h"
#include "services/archive/stored_rows.h"

namespace spindrift {
namespace {

Exclusions<SampleKind> read_exclusions(SQLite::Database& database,
                                       const std::string& spacecraft_id) {
  // The run must have samples: a run that only reconstructs has none of its own.
  SQLite::Statement query{database,
                          "SELECT run_id FROM run WHERE spacecraft_id = ? AND first_tai_ns IS NOT "
                          "NULL ORDER BY first_arrival DESC, started_utc DESC LIMIT 1"};
  query.bind(1, spacecraft_id);
  Exclusions<SampleKind> excluded;
  if (query.executeStep()) {
    const std::string run_id = query.getColumn(0).getString();
    for (const OperatorAction& action :
         read_actions_of_run(database, run_id, SpacecraftKind::ThreeAxis)) {
      if (const auto* const does = std::get_if<AttitudeAction>(&action.does)) {
        std::visit([&](const auto& what) { excluded.apply(action.t.value(), what); }, *does);
      }
    }
  }
  return excluded;
}

template <class Value>
std::vector<Value> read_from(const SQLite::Database& database, const std::string& spacecraft_id,
                             TaiTime from, const Exclusions<SampleKind>& excluded,
                             SenderNames& senders) {
  auto values = read_between<Value>(database, spacecraft_id, from, TaiTime::max(), senders);
  std::erase_if(values, [&](const Value& value) { return excluded.hold(value.t, kind_of(value)); });
  return values;
}

std::optional<StoredMission> newest_mission(const SQLite::Database& database) {
  SQLite::Statement query{database,
                          "SELECT run_id, config_toml, config_path, orbit_sha256 FROM run JOIN "
                          "spacecraft USING (spacecraft_id)"
                          " WHERE kind = 'three_axis' ORDER BY run.rowid DESC LIMIT 1"};
  if (!query.executeStep()) {
    return std::nullopt;
  }
  const SQLite::Column orbit = query.getColumn(3);
  return StoredMission{
      .run_id = query.getColumn(0).getString(),
      .config_toml = query.getColumn(1).getString(),
      .config_path = query.getColumn(2).getString(),
      .orbit_sha256 = orbit.isNull() ? std::nullopt : std::optional{orbit.getString()}};
}

}  // namespace

Expected<StoredMission> find_stored_mission(const std::filesystem::path& archive) {
  return read_archive(archive, newest_mission)
      .and_then([&](const std::optional<StoredMission>& newest) -> Expected<StoredMission> {
        if (!newest) {
          return Unexpected{{ErrorCode::InvalidConfiguration,
                             fmt::format("{}: no run of a three-axis spacecraft is stored there: "
                                         "give --mission and --telemetry",
                                         shown(archive.string()))}};
        }
        return *newest;
      });
}

Expected<SeparationSamples> find_separation_samples(const std::filesystem::path& archive,
                                                    const std::string& spacecraft_id,
                                                    const std::string& preferred_source,
                                                    TaiTime from) {
  return read_archive(archive, [&](SQLite::Database& database) {
    SenderNames senders{preferred_source};
    const auto excluded = read_exclusions(database, spacecraft_id);
    return SeparationSamples{
        .gyro = read_from<GyroSample>(database, spacecraft_id, from, excluded, senders),
        .sun = read_from<SunDirection>(database, spacecraft_id, from, excluded, senders),
        .stars = read_from<StarFix>(database, spacecraft_id, from, excluded, senders),
        .orbit_states =
            read_from<TimedOrbitState>(database, spacecraft_id, from, excluded, senders)};
  });
}

}  // namespace spindrift
