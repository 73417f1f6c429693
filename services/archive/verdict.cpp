#include "services/archive/verdict.h"

#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Statement.h>

#include "services/archive/connection.h"

namespace spindrift {

Expected<PassVerdict> find_verdict(const std::filesystem::path& archive,
                                   const std::string& run_id) {
  return read_archive(archive, [&](SQLite::Database& database) {
    SQLite::Statement query{
        database,
        "SELECT finished, ifnull(estimator, ''), ifnull(quality, ''), sigma_deg,"
        " why FROM pass_verdict WHERE run_id = ?"};
    query.bind(1, run_id);
    PassVerdict verdict;
    if (query.executeStep()) {
      verdict = {.finished = query.getColumn(0).getInt() != 0,
                 .estimator = query.getColumn(1).getString(),
                 .quality = query.getColumn(2).getString(),
                 .sigma_deg = query.getColumn(3).isNull()
                                  ? std::nullopt
                                  : std::optional{query.getColumn(3).getDouble()},
                 .why = query.getColumn(4).getString()};
    }
    return verdict;
  });
}

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
