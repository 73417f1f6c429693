#include "services/archive/disagreement.h"

#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Statement.h>

#include "services/archive/connection.h"

namespace spindrift {

Expected<std::vector<Disagreement>> find_disagreements(const std::filesystem::path& archive,
                                                       const std::string& run_id) {
  return read_archive(archive, [&](SQLite::Database& database) {
    SQLite::Statement query{database,
                            "SELECT one, other, apart_deg, apart_sigmas FROM spin_comparison"
                            " WHERE run_id = ? AND disagree ORDER BY one, other"};
    query.bind(1, run_id);
    std::vector<Disagreement> found;
    while (query.executeStep()) {
      found.push_back({.one = query.getColumn(0).getString(),
                       .other = query.getColumn(1).getString(),
                       .apart_deg = query.getColumn(2).getDouble(),
                       .apart_sigmas = query.getColumn(3).getDouble()});
    }
    return found;
  });
}

}  // namespace spindrift
