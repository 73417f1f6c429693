#include "services/archive/verdict.h"

#include <SQLiteCpp/Statement.h>
#include <SQLiteCpp/Transaction.h>
#include <fmt/format.h>

#include <optional>

#include "pipelines/time/utc.h"
#include "services/archive/connection.h"

namespace spindrift {

namespace {

std::optional<Quality> quality_named(const std::string& name) {
  for (int i = 0; i < kQualities; ++i) {
    if (const auto quality = static_cast<Quality>(i); name_of(quality) == name) {
      return quality;
    }
  }
  return std::nullopt;
}

std::optional<SeparationVerdict> separation_of(SQLite::Statement& query,
                                               const std::string& run_id) {
  query.reset();
  query.bind(1, run_id);
  if (!query.executeStep()) {
    return std::nullopt;
  }
  SeparationVerdict verdict{
      .method = query.getColumn(0).getString(),
      .quality = quality_named(query.getColumn(1).getString()).value_or(Quality::Lost),
      .t1 = tai_from_ns(query.getColumn(2).getInt64()),
      .sigma_deg = query.getColumn(3).getDouble(),
      .why = query.getColumn(4).getString(),
      .says = {}};
  verdict.says = fmt::format("T1 {}: {} by {}, sigma {:.3g} deg", format_utc(verdict.t1),
                             name_of(verdict.quality), verdict.method, verdict.sigma_deg);
  return verdict;
}

PassVerdict verdict_of(SQLite::Statement& query, const std::string& run_id) {
  query.reset();
  query.bind(1, run_id);
  if (!query.executeStep()) {
    return {};
  }
  const auto number = [&](int column) {
    const SQLite::Column value = query.getColumn(column);
    return value.isNull() ? std::nullopt : std::optional{value.getDouble()};
  };
  return {.finished = query.getColumn(0).getInt() != 0,
          .estimator = query.getColumn(1).getString(),
          .quality = quality_named(query.getColumn(2).getString()),
          .t = query.getColumn(11).isNull()
                   ? std::nullopt
                   : std::optional{tai_from_ns(query.getColumn(11).getInt64())},
          .sigma_deg = number(3),
          .noise_sigma_deg = number(10),
          .ra_deg = number(4),
          .dec_deg = number(5),
          .spin_rate_rpm = number(6),
          .sigma_rpm = number(7),
          .why = query.getColumn(8).getString(),
          .against = query.getColumn(9).getString()};
}

}  // namespace

std::vector<PassVerdict> verdicts_in(SQLite::Database& archive,
                                     const std::vector<std::string>& run_ids) {
  // In one transaction the pages read for one verdict are cached for the next.
  const SQLite::Transaction moment{archive};
  SQLite::Statement query{
      archive,
      "SELECT finished, ifnull(estimator, ''), ifnull(quality, ''), sigma_deg, ra_deg, dec_deg,"
      " spin_rate_rpm, sigma_rpm, why, against, noise_sigma_deg, t_tai_ns FROM pass_verdict"
      " WHERE run_id = ?"};
  SQLite::Statement separation{archive,
                               "SELECT method, quality, t1_tai_ns, sigma_deg, why"
                               " FROM separation_verdict WHERE run_id = ?"};
  std::vector<PassVerdict> verdicts;
  verdicts.reserve(run_ids.size());
  for (const std::string& run_id : run_ids) {
    verdicts.push_back(verdict_of(query, run_id));
    verdicts.back().separation = separation_of(separation, run_id);
  }
  return verdicts;
}

Expected<PassVerdict> find_verdict(const std::filesystem::path& archive,
                                   const std::string& run_id) {
  return read_archive(
      archive, [&](SQLite::Database& database) { return verdicts_in(database, {run_id}).front(); });
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
