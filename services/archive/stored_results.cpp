#include "services/archive/stored_results.h"

#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Statement.h>

#include <algorithm>
#include <string_view>
#include <variant>

#include "services/archive/connection.h"
#include "services/archive/row_values.h"
#include "services/units/degrees.h"

namespace spindrift {
namespace {

template <class Value>
bool has(const std::vector<Value>& sorted, const Value& value) {
  return std::binary_search(sorted.begin(), sorted.end(), value);
}

/// From the column `east_east` and the two behind it.
Eigen::Matrix2d covariance_of(SQLite::Statement& row, int east_east) {
  const double east_north = row.getColumn(east_east + 1).getDouble();
  Eigen::Matrix2d deg2;
  deg2 << row.getColumn(east_east).getDouble(), east_north, east_north,
      row.getColumn(east_east + 2).getDouble();
  return deg2 * (kRadPerDeg * kRadPerDeg);
}

void read_last_fix(const SQLite::Database& database, const std::string& run_id,
                   StoredResults& stored) {
  SQLite::Statement row{database,
                        "SELECT revolution, t_tai_ns, geometry_case, ra_deg, dec_deg,"
                        " cov_east_east_deg2, cov_east_north_deg2, cov_north_north_deg2,"
                        " resolution, norm, accepted, alternate_ra_deg, alternate_dec_deg"
                        " FROM spin_fix WHERE run_id = ? AND (accepted OR resolution = 'AMBIGUOUS')"
                        " ORDER BY revolution DESC LIMIT 1"};
  row.bind(1, run_id);
  if (!row.executeStep()) {
    return;
  }
  SpinFix fix{.revolution = row.getColumn(0).getInt64(),
              .t = tai_from_ns(row.getColumn(1).getInt64()),
              .geometry_case = row.getColumn(2).getInt(),
              .axis_icrf = axis_of(row, 3),
              .covariance_rad2 = covariance_of(row, 5),
              .alternates = {},
              .resolution = named(row.getColumn(8).getText(), Resolution::Ambiguous),
              .norm = row.getColumn(9).getDouble(),
              .accepted = row.getColumn(10).getInt() != 0};
  if (!row.getColumn(11).isNull()) {
    fix.alternates = {{.axis_icrf = axis_of(row, 11)}};
  }
  stored.in_force.emplace_back(std::move(fix));
}

void read_last_estimate(const SQLite::Database& database, const std::string& run_id,
                        SpinEstimator estimator, StoredResults& stored) {
  SQLite::Statement row{database,
                        "SELECT t_tai_ns, ra_deg, dec_deg, cov_east_east_deg2, cov_east_north_deg2,"
                        " cov_north_north_deg2, spin_rate_rpm, sigma_rpm, status FROM spin_estimate"
                        " WHERE run_id = ? AND estimator = ? ORDER BY t_tai_ns DESC LIMIT 1"};
  row.bind(1, run_id);
  row.bind(2, std::string{name_of(estimator)});
  if (row.executeStep()) {
    stored.in_force.emplace_back(
        SpinEstimate{.t = tai_from_ns(row.getColumn(0).getInt64()),
                     .estimator = estimator,
                     .axis_icrf = axis_of(row, 1),
                     .covariance_rad2 = covariance_of(row, 3),
                     .spin_rate_rad_s = row.getColumn(6).getDouble() / kRpmPerRad_s,
                     .spin_rate_sigma_rad_s = row.getColumn(7).getDouble() / kRpmPerRad_s,
                     .status = row.getColumn(8).getString()});
  }
}

void read_all(const SQLite::Database& database, const std::string& run_id, StoredResults& stored) {
  SQLite::Statement fixes{database,
                          "SELECT revolution, accepted FROM spin_fix WHERE run_id = ?"
                          " AND (accepted OR resolution = 'AMBIGUOUS') ORDER BY revolution"};
  fixes.bind(1, run_id);
  while (fixes.executeStep()) {
    auto& revolutions = fixes.getColumn(1).getInt() != 0 ? stored.accepted_revolutions
                                                         : stored.ambiguous_revolutions;
    revolutions.push_back(fixes.getColumn(0).getInt64());
  }
  SQLite::Statement estimates{
      database, "SELECT estimator, t_tai_ns FROM spin_estimate WHERE run_id = ? ORDER BY t_tai_ns"};
  estimates.bind(1, run_id);
  while (estimates.executeStep()) {
    stored.estimates[named(estimates.getColumn(0).getText(), SpinEstimator::Batch)].push_back(
        tai_from_ns(estimates.getColumn(1).getInt64()));
  }
}

}  // namespace

bool StoredResults::hold(const SpinProduct& product) const {
  if (const auto* estimate = std::get_if<SpinEstimate>(&product)) {
    const auto of_estimator = estimates.find(estimate->estimator);
    return of_estimator != estimates.end() && has(of_estimator->second, estimate->t);
  }
  const auto* fix = std::get_if<SpinFix>(&product);
  return fix != nullptr && (has(accepted_revolutions, fix->revolution) ||
                            (!fix->accepted && has(ambiguous_revolutions, fix->revolution)));
}

Expected<StoredResults> find_stored_results(const std::filesystem::path& archive,
                                            const std::string& run_id) {
  return read_archive(archive, [&](SQLite::Database& database) {
    StoredResults stored;
    read_last_fix(database, run_id, stored);
    using enum SpinEstimator;
    for (const SpinEstimator estimator : {Mean, Sequential, Batch}) {
      read_last_estimate(database, run_id, estimator, stored);
    }
    read_all(database, run_id, stored);
    return stored;
  });
}

}  // namespace spindrift
