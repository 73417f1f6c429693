#include "services/archive/stored_edges.h"

#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Statement.h>
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <span>
#include <variant>
#include <vector>

#include "pipelines/frames/celestial.h"
#include "pipelines/spin/disambiguation/chosen_root.h"
#include "services/archive/connection.h"
#include "services/archive/stored_pass.h"
#include "services/base/degrees.h"
#include "services/products/named.h"

namespace spindrift {
namespace {

/// Finds the run, or the newest one with revolutions; its edges are not read yet.
std::optional<StoredEdges> find_run(SQLite::Database& database, const std::string& spacecraft_id,
                                    const std::optional<std::string>& run_id) {
  SQLite::Statement query{
      database,
      "SELECT run_id, config_sha256, orbit_sha256 FROM run WHERE spacecraft_id = ?1 AND "
      "ifnull(run_id = ?2, 1)"
      // Table `revolution` will not do: without sun1 a run has no rows there.
      " AND EXISTS (SELECT 1 FROM pulse_use AS one WHERE one.run_id = run.run_id"
      "  AND revolution IS NOT NULL)"
      " ORDER BY first_arrival DESC, started_utc DESC LIMIT 1"};
  query.bind(1, spacecraft_id);
  if (run_id) {
    query.bind(2, *run_id);
  }
  if (!query.executeStep()) {
    return std::nullopt;
  }
  const SQLite::Column orbit = query.getColumn(2);
  return StoredEdges{
      .run_id = query.getColumn(0).getString(),
      .config_sha256 = query.getColumn(1).getString(),
      .orbit_sha256 = orbit.isNull() ? std::nullopt : std::optional{orbit.getString()},
      .told_prior = {},
      .pass = {}};
}

/// Reads right ascension and declination from the columns 0 and 1.
Eigen::Vector3d axis_of(SQLite::Statement& row) {
  return direction_icrf({.ra_rad = row.getColumn(0).getDouble() * kRadPerDeg,
                         .dec_rad = row.getColumn(1).getDouble() * kRadPerDeg});
}

/// Selects the axis of a fix first, then those of its other candidates.
/// @param fix Name of a row set with the columns of spin_fix.
std::string select_axes_of(const char* fix) {
  return fmt::format(
      " SELECT c.ra_deg, c.dec_deg FROM {} JOIN spin_fix_candidate AS c"
      " USING (run_id, revolution) ORDER BY c.candidate",
      fix);
}

PulseUse use_of(SQLite::Statement& row) {
  PulseUse use{.pulse = {.t = tai_from_ns(row.getColumn(0).getInt64()),
                         .channel = named(row.getColumn(1).getText(), PulseChannel::SouthOut)},
               .revolution = row.getColumn(2).getInt64(),
               .rejected_by = {}};
  if (!row.getColumn(3).isNull()) {
    use.rejected_by = named(row.getColumn(3).getText(), Rejection::MixedAzimuth);
  }
  return use;
}

/// Returns whether the run has reached `t`, so that an action from `t` on has been applied.
bool has_come_to(SQLite::Database& database, const std::string& run_id, TaiTime t) {
  SQLite::Statement query{
      database,
      "SELECT EXISTS (SELECT 1 FROM spin_fix WHERE run_id = ?1 AND t_tai_ns >= ?2)"
      " OR EXISTS (SELECT 1 FROM spin_estimate WHERE run_id = ?1 AND t_tai_ns >= ?2"
      "  AND estimator IN ('mean', 'sequential'))"};
  query.bind(1, run_id);
  query.bind(2, tai_ns(t));
  query.executeStep();
  return query.getColumn(0).getInt() != 0;
}

/// Returns the prior that SpinPass makes of the choice: at the first unambiguous fix from then on
/// with alternates, the candidate nearest to it. Empty when there is none.
std::optional<SpinPrior> chosen_root(SQLite::Database& database, const std::string& run_id,
                                     const ChooseRoot& choice, TaiTime from, TaiTime to) {
  SQLite::Statement query{
      database,
      "WITH chosen AS (SELECT * FROM spin_fix WHERE run_id = ?1 AND t_tai_ns >= ?2 AND"
      "  t_tai_ns < ?3 AND resolution <> 'AMBIGUOUS' AND alternate_ra_deg IS NOT NULL"
      "  ORDER BY t_tai_ns LIMIT 1)" +
          select_axes_of("chosen")};
  query.bind(1, run_id);
  query.bind(2, tai_ns(from));
  query.bind(3, tai_ns(to));
  std::vector<Eigen::Vector3d> axes_icrf;
  while (query.executeStep()) {
    axes_icrf.push_back(axis_of(query));
  }
  if (axes_icrf.empty()) {
    return std::nullopt;
  }
  const auto root =
      std::min_element(axes_icrf.begin(), axes_icrf.end(), [&](const auto& a, const auto& b) {
        return angle_between_rad(choice.axis_icrf, a) < angle_between_rad(choice.axis_icrf, b);
      });
  std::iter_swap(axes_icrf.begin(), root);
  return prior_choosing(axes_icrf.front(), std::span{axes_icrf}.subspan(1));
}

bool is_of_prior(const SpinAction& action) {
  return std::holds_alternative<SetPrior>(action) || std::holds_alternative<ChooseRoot>(action);
}

/// Each prior holds until the next one.
void read_told_prior(SQLite::Database& database, const std::multimap<TaiTime, SpinAction>& of_prior,
                     StoredEdges& stored) {
  for (auto said = of_prior.begin(); said != of_prior.end(); ++said) {
    const auto next = std::next(said);
    if (const auto* const choice = std::get_if<ChooseRoot>(&said->second)) {
      const TaiTime until = next == of_prior.end() ? TaiTime::max() : next->first;
      const auto root = chosen_root(database, stored.run_id, *choice, said->first, until);
      stored.told_prior = root ? root : stored.told_prior;
    } else if (has_come_to(database, stored.run_id, said->first)) {
      stored.told_prior = std::get<SetPrior>(said->second).prior;
    }
  }
}

void read_actions(SQLite::Database& database, StoredEdges& stored) {
  std::multimap<TaiTime, SpinAction> of_prior;
  for (const OperatorAction& action :
       read_actions_of_run(database, stored.run_id, SpacecraftKind::Spin)) {
    const auto* const does = std::get_if<SpinAction>(&action.does);
    if (does == nullptr) {
      continue;
    }
    stored.pass.act(action.t.value(), *does);
    if (is_of_prior(*does)) {
      of_prior.emplace(action.t.value(), *does);
    }
  }
  read_told_prior(database, of_prior, stored);
}

void read_uses(SQLite::Database& database, StoredEdges& stored) {
  SQLite::Statement query{database,
                          "SELECT t_tai_ns, channel, revolution, rejected_by FROM pulse_use"
                          " WHERE run_id = ? AND revolution IS NOT NULL ORDER BY t_tai_ns"};
  query.bind(1, stored.run_id);
  while (query.executeStep()) {
    stored.pass.collect(SpinProduct{use_of(query)});
  }
}

void read_estimate(SQLite::Database& database, SpinEstimator estimator, StoredEdges& stored) {
  SQLite::Statement query{database,
                          "SELECT ra_deg, dec_deg, quality FROM spin_estimate"
                          " WHERE run_id = ? AND estimator = ? ORDER BY t_tai_ns DESC LIMIT 1"};
  query.bind(1, stored.run_id);
  query.bind(2, std::string{name_of(estimator)});
  if (query.executeStep()) {
    stored.pass.collect(SpinProduct{
        SpinEstimate{.t = {},
                     .estimator = estimator,
                     .axis_icrf = axis_of(query),
                     .covariance_rad2 = Eigen::Matrix2d::Zero(),
                     .spin_rate_rad_s = 0.0,
                     .spin_rate_sigma_rad_s = 0.0,
                     .assessment = {named(query.getColumn(2).getText(), Quality::Lost)}}});
  }
}

void read_last_fix(SQLite::Database& database, StoredEdges& stored) {
  SQLite::Statement query{
      database,
      "WITH last AS (SELECT * FROM spin_fix WHERE run_id = ? ORDER BY revolution DESC LIMIT 1)" +
          select_axes_of("last")};
  query.bind(1, stored.run_id);
  std::optional<SpinFix> fix;
  while (query.executeStep()) {
    if (fix) {
      fix->alternates.push_back({.axis_icrf = axis_of(query)});
    } else {
      fix = SpinFix{.revolution = 0,
                    .t = {},
                    .geometry_case = 0,
                    .axis_icrf = axis_of(query),
                    .covariance_rad2 = Eigen::Matrix2d::Zero(),
                    .alternates = {},
                    .resolution = Resolution::Ambiguous,
                    .norm = 1.0,
                    .accepted = false};
    }
  }
  if (fix) {
    stored.pass.collect(SpinProduct{*std::move(fix)});
  }
}

}  // namespace

Expected<StoredEdges> read_edges(const std::filesystem::path& archive,
                                 const std::string& spacecraft_id,
                                 const std::optional<std::string>& run_id) {
  const auto read = read_archive(archive, [&](SQLite::Database& database) {
    std::optional<StoredEdges> stored = find_run(database, spacecraft_id, run_id);
    if (stored) {
      read_actions(database, *stored);
      read_uses(database, *stored);
      read_estimate(database, SpinEstimator::Mean, *stored);
      read_estimate(database, SpinEstimator::Sequential, *stored);
      read_last_fix(database, *stored);
    }
    return stored;
  });
  if (!read) {
    return Unexpected{read.error()};
  }
  if (!*read) {
    return Unexpected{{ErrorCode::InvalidConfiguration,
                       fmt::format("archive {} has no run{} of spacecraft '{}' with revolutions",
                                   archive.string(), run_id ? " " + *run_id : "", spacecraft_id)}};
  }
  return **read;
}

}  // namespace spindrift
