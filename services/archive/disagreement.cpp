#include "services/archive/disagreement.h"

#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Statement.h>
#include <fmt/format.h>

#include "services/archive/connection.h"

namespace spindrift {

std::string in_words(const Disagreement& disagreement) {
  return fmt::format(
      "{} and {} disagree: their axes are {:.3f} deg apart, {:.1f} times the larger sigma",
      disagreement.one, disagreement.other, disagreement.apart_deg, disagreement.apart_sigmas);
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
