#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Statement.h>

#include <utility>

#include "services/archive/connection.h"
#include "services/archive/stored_pass.h"
#include "services/base/parsed_json.h"
#include "services/operator/parse_action.h"

namespace spindrift {
namespace {

constexpr const char* kColumns =
    "SELECT action_id, operator_action.spacecraft_id, t_tai_ns, made_utc, by, action, arguments,"
    " note, arrival FROM operator_action JOIN run USING (run_id) ";

std::vector<OperatorAction> read_all(SQLite::Statement& query, SpacecraftKind kind) {
  std::vector<OperatorAction> actions;
  while (query.executeStep()) {
    OperatorAction action{.action_id = query.getColumn(0).getString(),
                          .spacecraft = query.getColumn(1).getString(),
                          .t = tai_from_ns(query.getColumn(2).getInt64()),
                          .made_utc = query.getColumn(3).getString(),
                          .by = query.getColumn(4).getString(),
                          .action = query.getColumn(5).getString(),
                          .arguments = query.getColumn(6).getString(),
                          .note = query.getColumn(7).getString(),
                          .does = {},
                          .arrival = {query.getColumn(8).getInt64()}};
    auto does = what_it_does(kind, action.action, parsed_json(action.arguments));
    if (does) {
      action.does = *std::move(does);
      actions.push_back(std::move(action));
    }
  }
  return actions;
}

}  // namespace

Expected<std::vector<OperatorAction>> find_stored_actions(const std::filesystem::path& archive,
                                                          const std::string& spacecraft_id,
                                                          const RunStart& start) {
  return read_archive(archive, [&](SQLite::Database& database) {
    SQLite::Statement query{
        database, std::string{kColumns} +
                      "WHERE operator_action.spacecraft_id = ? AND mode = ? ORDER BY arrival"};
    query.bind(1, spacecraft_id);
    query.bind(2, std::string{name_of(start.mode)});
    return read_all(query, start.spacecraft_kind);
  });
}

std::vector<OperatorAction> read_actions_of_run(SQLite::Database& database,
                                                const std::string& run_id, SpacecraftKind kind) {
  SQLite::Statement query{
      database, std::string{kColumns} +
                    "JOIN run AS one ON one.run_id = ? AND one.spacecraft_id = run.spacecraft_id"
                    " AND one.mode = run.mode AND one.first_arrival >= run.first_arrival"
                    " ORDER BY arrival"};
  query.bind(1, run_id);
  return read_all(query, kind);
}

}  // namespace spindrift
