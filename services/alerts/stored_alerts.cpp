#include "services/alerts/stored_alerts.h"

#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Statement.h>

#include "services/archive/connection.h"
#include "services/products/alert.h"
#include "services/products/named.h"

namespace spindrift {
namespace {

/// Adapts a statement to the Row that ProductKind<Alert>::from_row needs.
class NamedRow {
 public:
  explicit NamedRow(SQLite::Statement& row) : row_{row} {}
  bool has(const char* column) const { return !row_.getColumn(column).isNull(); }
  std::int64_t integer(const char* column) const { return row_.getColumn(column).getInt64(); }
  std::string text(const char* column) const { return row_.getColumn(column).getString(); }

 private:
  SQLite::Statement& row_;
};

}  // namespace

std::vector<StoredAlert> alerts_in(SQLite::Database& archive) {
  SQLite::Statement query{archive,
                          "SELECT alert.*, run.mode FROM alert JOIN run USING (run_id)"
                          " ORDER BY run.first_arrival, raised_tai_ns, alert_id"};
  std::vector<StoredAlert> alerts;
  while (query.executeStep()) {
    const NamedRow row{query};
    alerts.push_back({.run_id = row.text("run_id"),
                      .spacecraft = row.text("spacecraft_id"),
                      .mode = named(row.text("mode"), RunMode::Replay),
                      .alert = ProductKind<Alert>::from_row(row)});
  }
  return alerts;
}

Expected<std::vector<StoredAlert>> find_alerts(const std::filesystem::path& archive) {
  return read_archive(archive, &alerts_in);
}

Expected<std::vector<StoredTransition>> find_transitions(const std::filesystem::path& archive,
                                                         RunMode mode) {
  return read_archive(archive, [&](SQLite::Database& database) {
    SQLite::Statement query{database,
                            "SELECT spacecraft_id, t_tai_ns FROM alert_transition"
                            " JOIN run USING (run_id) WHERE mode = ?"
                            " ORDER BY first_arrival, t_tai_ns"};
    query.bind(1, std::string{name_of(mode)});
    std::vector<StoredTransition> transitions;
    while (query.executeStep()) {
      transitions.push_back({.spacecraft = query.getColumn(0).getString(),
                             .t = tai_from_ns(query.getColumn(1).getInt64())});
    }
    return transitions;
  });
}

}  // namespace spindrift
