#include "services/archive/stored_faults.h"

#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Statement.h>

#include "services/archive/connection.h"

namespace spindrift {

Expected<std::vector<RunFault>> find_faults(const std::filesystem::path& archive,
                                            const std::string& run_id) {
  return read_archive(archive, [&](SQLite::Database& database) {
    SQLite::Statement query{
        database, "SELECT t_tai_ns, what FROM run_fault WHERE run_id = ? ORDER BY t_tai_ns"};
    query.bind(1, run_id);
    std::vector<RunFault> faults;
    while (query.executeStep()) {
      faults.push_back({.t = tai_from_ns(query.getColumn(0).getInt64()),
                        .what = query.getColumn(1).getString()});
    }
    return faults;
  });
}

Expected<std::map<std::string, std::int64_t>> count_contradictions(
    const std::filesystem::path& archive, const std::string& run_id) {
  return read_archive(archive, [&](SQLite::Database& database) {
    SQLite::Statement query{database,
                            "SELECT kind, count(DISTINCT t_tai_ns) FROM contradiction"
                            " WHERE run_id = ? GROUP BY kind"};
    query.bind(1, run_id);
    std::map<std::string, std::int64_t> counts;
    while (query.executeStep()) {
      counts.emplace(query.getColumn(0).getString(), query.getColumn(1).getInt64());
    }
    return counts;
  });
}

}  // namespace spindrift
