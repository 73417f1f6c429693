#include "services/archive/batch_writer.h"

#include <SQLiteCpp/Transaction.h>

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

#include "services/archive/connection.h"
#include "services/units/degrees.h"

namespace spindrift {
namespace {

void bind(SQLite::Statement& statement, int index, std::int64_t value) {
  statement.bind(index, value);
}
void bind(SQLite::Statement& statement, int index, double value) { statement.bind(index, value); }
void bind(SQLite::Statement& statement, int index, const std::string& value) {
  statement.bindNoCopy(index, value);
}
// A name_of(...): a literal, hence ended by a NUL and there for good.
void bind(SQLite::Statement& statement, int index, std::string_view literal) {
  statement.bindNoCopy(index, literal.data());
}
template <class T>
void bind(SQLite::Statement& statement, int index, const std::optional<T>& value) {
  if (value) {
    bind(statement, index, *value);
  } else {
    statement.bind(index);
  }
}

// Text is bound without a copy, so `values` must outlive the call and no more.
template <class... Values>
void execute(SQLite::Statement& statement, const Values&... values) {
  statement.tryReset();  // Its status is that of the last step, which was reported then.
  int index = 0;
  (bind(statement, ++index, values), ...);
  statement.exec();
}

std::int64_t as_signed(std::uint64_t value) { return static_cast<std::int64_t>(value); }
std::int64_t as_flag(bool value) { return value ? 1 : 0; }

std::optional<std::string_view> name_of(const std::optional<Rejection>& rejected_by) {
  return rejected_by ? std::optional{spindrift::name_of(*rejected_by)} : std::nullopt;
}

// What is stored already stays as it is, but for its place in the order of the run that takes it
// now: of ?8, where ?7 is its arrival.
constexpr const char* kTakenByALaterRun =
    " ON CONFLICT DO UPDATE SET arrival = excluded.arrival"
    " WHERE arrival < (SELECT first_arrival FROM run WHERE run_id = ?8)";

// The first word of the status.
std::string quality_of(const SpinEstimate& estimate) {
  const std::string& status = estimate.status;
  return status.substr(0, status.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ"));
}

struct CovarianceColumns {
  double sigma_deg;
  double east_east_deg2;
  double east_north_deg2;
  double north_north_deg2;
};

CovarianceColumns columns_of(const Eigen::Matrix2d& covariance_rad2) {
  const Eigen::Matrix2d deg2 = covariance_rad2 * (kDegPerRad * kDegPerRad);
  return {.sigma_deg = sigma_deg(covariance_rad2),
          .east_east_deg2 = deg2(0, 0),
          .east_north_deg2 = deg2(0, 1),
          .north_north_deg2 = deg2(1, 1)};
}

}  // namespace

BatchWriter::BatchWriter(SQLite::Database& database)
    : database_{database},
      spacecraft_{database,
                  "INSERT INTO spacecraft (spacecraft_id, name, kind) VALUES (?1, ?1, ?2)"
                  " ON CONFLICT DO UPDATE SET kind = excluded.kind"},
      run_{database,
           "INSERT INTO run (run_id, spacecraft_id, mode, software_version, config_toml,"
           " config_sha256, orbit_sha256, started_utc, first_arrival)"
           " VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?)"},
      run_telemetry_{database,
                     "INSERT INTO run_telemetry (run_id, position, telemetry) VALUES (?, ?, ?)"},
      run_finished_{database, "UPDATE run SET finished_utc = ? WHERE run_id = ?"},
      run_earliest_{database,
                    "UPDATE run SET first_tai_ns = min(ifnull(first_tai_ns, ?1), ?1)"
                    " WHERE run_id = ?2"},
      pulse_{database,
             std::string{"INSERT INTO pulse (spacecraft_id, t_tai_ns, channel, source, session,"
                         " seq, arrival) VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7)"} +
                 kTakenByALaterRun},
      coded_frame_{database,
                   std::string{"INSERT INTO coded_frame (spacecraft_id, t_tai_ns, period_s, sun2_s,"
                               " north_in_s, north_out_s, south_in_s, south_out_s, source, session,"
                               " seq, arrival)"
                               " VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?9, ?10, ?11, ?12, ?13, ?7)"} +
                       kTakenByALaterRun},
      rejected_input_{database,
                      "INSERT INTO rejected_input (run_id, source, session, line, reason)"
                      " VALUES (?, ?, ?, ?, ?) ON CONFLICT DO NOTHING"},
      source_count_{database,
                    "INSERT OR REPLACE INTO source_count (run_id, source, received, gaps,"
                    " duplicates, disordered) VALUES (?, ?, ?, ?, ?, ?)"},
      pulse_use_{database,
                 "INSERT INTO pulse_use (run_id, spacecraft_id, t_tai_ns, channel, revolution,"
                 " accepted, rejected_by) VALUES (?, ?, ?, ?, ?, ?, ?) ON CONFLICT DO UPDATE SET"
                 " revolution = excluded.revolution, accepted = excluded.accepted,"
                 " rejected_by = excluded.rejected_by WHERE excluded.rejected_by IS NOT 'late'"},
      revolution_{database,
                  "INSERT OR REPLACE INTO revolution (run_id, revolution, t_tai_ns, period_s)"
                  " VALUES (?, ?, ?, ?)"},
      spin_measurement_{database,
                        "INSERT OR REPLACE INTO spin_measurement (run_id, revolution, quantity,"
                        " value, unit, sigma, accepted, rejected_by)"
                        " VALUES (?, ?, ?, ?, ?, ?, ?, ?)"},
      spin_fix_{database,
                "INSERT OR REPLACE INTO spin_fix (run_id, revolution, t_tai_ns, geometry_case,"
                " ra_deg, dec_deg, sigma_deg, cov_east_east_deg2, cov_east_north_deg2,"
                " cov_north_north_deg2, alternate_ra_deg, alternate_dec_deg, resolution, norm,"
                " accepted) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)"},
      spin_fix_candidates_gone_{database,
                                "DELETE FROM spin_fix_candidate WHERE run_id = ? AND"
                                " revolution = ?"},
      spin_fix_candidate_{database,
                          "INSERT INTO spin_fix_candidate (run_id, revolution, candidate, ra_deg,"
                          " dec_deg) VALUES (?, ?, ?, ?, ?)"},
      spin_estimate_{database,
                     "INSERT OR REPLACE INTO spin_estimate (run_id, t_tai_ns, estimator, ra_deg,"
                     " dec_deg, sigma_deg, cov_east_east_deg2, cov_east_north_deg2,"
                     " cov_north_north_deg2, spin_rate_rpm, sigma_rpm, quality, reasons, status)"
                     " VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)"},
      spin_batch_{database,
                  "INSERT OR REPLACE INTO spin_batch (run_id, t_tai_ns, bound_deg, edges, outliers,"
                  " noise, iterations, changed_tai_ns, consider_sigma_deg, rate_drift_rpm_h,"
                  " rate_drift_sigma_rpm_h) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)"},
      spin_batch_singular_value_{database,
                                 "INSERT INTO spin_batch_singular_value (run_id, t_tai_ns,"
                                 " position, value) VALUES (?, ?, ?, ?)"},
      spin_batch_undetermined_{database,
                               "INSERT INTO spin_batch_undetermined (run_id, t_tai_ns, position,"
                               " direction) VALUES (?, ?, ?, ?)"},
      // Those of a later solution stay.
      spin_biases_gone_{database,
                        "DELETE FROM spin_bias WHERE run_id = ?1 AND estimator = 'batch' AND NOT"
                        " EXISTS (SELECT 1 FROM spin_batch WHERE run_id = ?1 AND t_tai_ns > ?2)"},
      spin_bias_{database,
                 "INSERT OR REPLACE INTO spin_bias (run_id, estimator, name, value, unit, sigma,"
                 " observable, estimated) SELECT ?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8 WHERE NOT EXISTS"
                 " (SELECT 1 FROM spin_batch WHERE run_id = ?1 AND t_tai_ns > ?9)"},
      spin_nutation_{database,
                     "INSERT OR REPLACE INTO spin_nutation (run_id, t_tai_ns, detected,"
                     " false_alarm, detectable_deg, half_angle_deg, half_angle_sigma_deg, period_s,"
                     " period_sigma_s, growth_per_h, growth_sigma_per_h, lean_azimuth_deg,"
                     " lean_azimuth_sigma_deg, at_tai_ns)"
                     " VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)"},
      spin_coning_{database,
                   "INSERT OR REPLACE INTO spin_coning (run_id, t_tai_ns, detected, detectable_deg,"
                   " tilt_deg, tilt_sigma_deg, azimuth_deg, azimuth_sigma_deg)"
                   " VALUES (?, ?, ?, ?, ?, ?, ?, ?)"} {}

Expected<void> BatchWriter::write(std::span<const ArchiveBatch> batches) {
  try {
    SQLite::Transaction transaction{database_, SQLite::TransactionBehavior::IMMEDIATE};
    for (const ArchiveBatch& batch : batches) {
      insert(batch);
    }
    insert_latest_counts(batches);
    transaction.commit();
    return {};
  } catch (const SQLite::Exception& exception) {
    return Unexpected{archive_error(database_.getFilename(), exception)};
  }
}

void BatchWriter::insert(const ArchiveBatch& batch) {
  if (batch.start) {
    insert(batch, *batch.start);
  }
  if (batch.continuation) {
    withdraw(batch, batch.continuation->t);
  }
  if (batch.earliest) {
    execute(run_earliest_, tai_ns(*batch.earliest), batch.run_id);
  }
  std::int64_t arrival = batch.arrival;
  for (const PulseSample& sample : batch.pulses) {
    insert(batch, sample, arrival++);
  }
  for (const CodedSample& sample : batch.coded) {
    insert(batch, sample, arrival++);
  }
  for (const RejectedInput& rejected : batch.rejected) {
    insert(batch.run_id, rejected);
  }
  for (const SpinProduct& product : batch.products) {
    std::visit([&](const auto& value) { insert(batch, value); }, product);
  }
  if (batch.batch) {
    insert(batch.run_id, *batch.batch);
  }
  if (batch.finished_utc) {
    execute(run_finished_, *batch.finished_utc, batch.run_id);
  }
}

// Each batch has the counts as they have come to be: of many only the last are seen.
void BatchWriter::insert_latest_counts(std::span<const ArchiveBatch> batches) {
  std::map<std::pair<std::string_view, std::string_view>, const SourceCount*> latest;
  for (const ArchiveBatch& batch : batches) {
    for (const SourceCount& count : batch.source_counts) {
      latest.insert_or_assign({batch.run_id, count.source}, &count);
    }
  }
  for (const auto& [key, count] : latest) {
    insert(std::string{key.first}, *count);
  }
}

void BatchWriter::insert(const ArchiveBatch& batch, const RunStart& start) {
  execute(spacecraft_, batch.spacecraft_id, start.spacecraft_kind);
  execute(run_, batch.run_id, batch.spacecraft_id, start.mode, start.software_version,
          start.config_toml, start.config_sha256, start.orbit_sha256, start.started_utc,
          start.first_arrival);
  std::int64_t position = 0;
  for (const std::string& telemetry : start.telemetry) {
    execute(run_telemetry_, batch.run_id, ++position, telemetry);
  }
}

void BatchWriter::withdraw(const ArchiveBatch& batch, TaiTime from) {
  const auto execute_for_run = [&](const char* sql) {
    SQLite::Statement statement{database_, sql};
    execute(statement, batch.run_id, tai_ns(from));
  };
  execute_for_run("UPDATE run SET finished_utc = NULL WHERE run_id = ?1 AND ?2 IS NOT NULL");
  execute_for_run(
      "DELETE FROM spin_measurement WHERE run_id = ?1 AND revolution >= (SELECT min(revolution) "
      "FROM"
      " (SELECT revolution FROM revolution WHERE run_id = ?1 AND t_tai_ns >= ?2"
      // A revolution without sun1 is known by its edges and its fix only.
      "  UNION ALL SELECT revolution FROM spin_fix WHERE run_id = ?1 AND t_tai_ns >= ?2"
      "  UNION ALL SELECT revolution FROM pulse_use"
      "   WHERE run_id = ?1 AND t_tai_ns >= ?2))");
  execute_for_run(
      "DELETE FROM spin_fix_candidate WHERE run_id = ?1 AND revolution IN"
      " (SELECT revolution FROM spin_fix WHERE run_id = ?1 AND t_tai_ns >= ?2)");
  execute_for_run("DELETE FROM revolution WHERE run_id = ?1 AND t_tai_ns >= ?2");
  execute_for_run("DELETE FROM spin_fix WHERE run_id = ?1 AND t_tai_ns >= ?2");
  execute_for_run("DELETE FROM spin_estimate WHERE run_id = ?1 AND t_tai_ns >= ?2");
  execute_for_run("DELETE FROM spin_coning WHERE run_id = ?1 AND t_tai_ns >= ?2");
  execute_for_run("DELETE FROM spin_nutation WHERE run_id = ?1 AND t_tai_ns >= ?2");
  // They are the last solution's.
  execute_for_run(
      "DELETE FROM spin_bias WHERE run_id = ?1 AND estimator = 'batch' AND EXISTS"
      " (SELECT 1 FROM spin_batch WHERE run_id = ?1 AND t_tai_ns >= ?2)");
  execute_for_run("DELETE FROM spin_batch WHERE run_id = ?1 AND t_tai_ns >= ?2");
  execute_for_run("DELETE FROM pulse_use WHERE run_id = ?1 AND t_tai_ns >= ?2");
}

void BatchWriter::insert(const ArchiveBatch& batch, const PulseSample& sample,
                         std::int64_t arrival) {
  execute(pulse_, sample.spacecraft, tai_ns(sample.pulse.t),
          spindrift::name_of(sample.pulse.channel), sample.origin.source,
          as_signed(sample.origin.session), as_signed(sample.origin.seq), arrival, batch.run_id);
}

void BatchWriter::insert(const ArchiveBatch& batch, const CodedSample& sample,
                         std::int64_t arrival) {
  const auto delay_s = [&](PulseChannel channel) {
    return sample.frame.delay_s.at(index_of(channel));
  };
  using enum PulseChannel;
  execute(coded_frame_, sample.spacecraft, tai_ns(sample.frame.t), sample.frame.period_s,
          delay_s(Sun2), delay_s(NorthIn), delay_s(NorthOut), arrival, batch.run_id,
          delay_s(SouthIn), delay_s(SouthOut), sample.origin.source,
          as_signed(sample.origin.session), as_signed(sample.origin.seq));
}

void BatchWriter::insert(const std::string& run_id, const RejectedInput& rejected) {
  execute(rejected_input_, run_id, rejected.source, as_signed(rejected.session), rejected.line,
          rejected.reason);
}

void BatchWriter::insert(const std::string& run_id, const SourceCount& count) {
  execute(source_count_, run_id, count.source, count.received, count.gaps, count.duplicates,
          count.disordered);
}

void BatchWriter::insert(const ArchiveBatch& batch, const PulseUse& use) {
  execute(pulse_use_, batch.run_id, batch.spacecraft_id, tai_ns(use.pulse.t),
          spindrift::name_of(use.pulse.channel), use.revolution, as_flag(!use.rejected_by),
          name_of(use.rejected_by));
}

void BatchWriter::insert(const ArchiveBatch& batch, const RevolutionProduct& revolution) {
  execute(revolution_, batch.run_id, revolution.revolution, tai_ns(revolution.t_sun1),
          revolution.period_s);
}

void BatchWriter::insert(const ArchiveBatch& batch, const SpinMeasurement& measurement) {
  const bool is_time = measurement.quantity == SpinQuantity::Period;
  const double to_unit = is_time ? 1.0 : kDegPerRad;
  execute(spin_measurement_, batch.run_id, measurement.revolution,
          spindrift::name_of(measurement.quantity), measurement.value * to_unit,
          std::string_view{is_time ? "s" : "deg"}, measurement.sigma * to_unit,
          as_flag(!measurement.rejected_by), name_of(measurement.rejected_by));
}

void BatchWriter::insert(const ArchiveBatch& batch, const SpinFix& fix) {
  const auto [ra_deg, dec_deg] = place_deg(fix.axis_icrf);
  const CovarianceColumns covariance = columns_of(fix.covariance_rad2);
  std::optional<double> alternate_ra_deg;
  std::optional<double> alternate_dec_deg;
  if (!fix.alternates.empty()) {
    const PlaceDeg alternate = place_deg(fix.alternates.front().axis_icrf);
    alternate_ra_deg = alternate.ra_deg;
    alternate_dec_deg = alternate.dec_deg;
  }
  execute(spin_fix_, batch.run_id, fix.revolution, tai_ns(fix.t), std::int64_t{fix.geometry_case},
          ra_deg, dec_deg, covariance.sigma_deg, covariance.east_east_deg2,
          covariance.east_north_deg2, covariance.north_north_deg2, alternate_ra_deg,
          alternate_dec_deg, spindrift::name_of(fix.resolution), fix.norm, as_flag(fix.accepted));
  insert_candidates(batch, fix);
}

void BatchWriter::insert_candidates(const ArchiveBatch& batch, const SpinFix& fix) {
  // The fix may take the place of one that had others.
  execute(spin_fix_candidates_gone_, batch.run_id, fix.revolution);
  if (fix.alternates.size() < 2) {
    return;
  }
  std::int64_t candidate = 0;
  for (const SpinAlternate& alternate : fix.alternates) {
    const auto [ra_deg, dec_deg] = place_deg(alternate.axis_icrf);
    execute(spin_fix_candidate_, batch.run_id, fix.revolution, ++candidate, ra_deg, dec_deg);
  }
}

void BatchWriter::insert(const ArchiveBatch& batch, const SpinEstimate& estimate) {
  const auto [ra_deg, dec_deg] = place_deg(estimate.axis_icrf);
  const CovarianceColumns covariance = columns_of(estimate.covariance_rad2);
  execute(spin_estimate_, batch.run_id, tai_ns(estimate.t), spindrift::name_of(estimate.estimator),
          ra_deg, dec_deg, covariance.sigma_deg, covariance.east_east_deg2,
          covariance.east_north_deg2, covariance.north_north_deg2,
          estimate.spin_rate_rad_s * kRpmPerRad_s, estimate.spin_rate_sigma_rad_s * kRpmPerRad_s,
          quality_of(estimate), std::string_view{"[]"}, estimate.status);
}

void BatchWriter::insert(const std::string& run_id, const BatchSolution& solution) {
  std::optional<std::int64_t> changed_tai_ns;
  if (solution.changed) {
    changed_tai_ns = tai_ns(*solution.changed);
  }
  execute(spin_batch_, run_id, tai_ns(solution.estimate.t), solution.bound_rad * kDegPerRad,
          solution.edges, solution.outliers, solution.noise, std::int64_t{solution.iterations},
          changed_tai_ns, solution.consider_sigma_rad * kDegPerRad,
          solution.drift_rad_s2 * kRpmPerHourPerRad_s2,
          solution.drift_sigma_rad_s2 * kRpmPerHourPerRad_s2);
  insert_observability(run_id, solution);
  insert_biases(run_id, solution);
  if (solution.nutation) {
    insert(run_id, solution, *solution.nutation);
  }
  insert(run_id, solution.estimate.t, solution.coning);
}

void BatchWriter::insert_observability(const std::string& run_id, const BatchSolution& solution) {
  const std::int64_t t_tai_ns = tai_ns(solution.estimate.t);
  std::int64_t position = 0;
  for (const double value : solution.singular_values) {
    execute(spin_batch_singular_value_, run_id, t_tai_ns, ++position, value);
  }
  position = 0;
  for (const std::string& direction : solution.undetermined) {
    execute(spin_batch_undetermined_, run_id, t_tai_ns, ++position, direction);
  }
}

void BatchWriter::insert_biases(const std::string& run_id, const BatchSolution& solution) {
  const std::int64_t t_tai_ns = tai_ns(solution.estimate.t);
  // A channel that fell silent has no row any more.
  execute(spin_biases_gone_, run_id, t_tai_ns);
  for (const BiasEstimate& bias : solution.biases) {
    const BiasPrior& prior = prior_of(bias.bias);
    const double to_unit = prior.is_angle ? kDegPerRad : 1.0;
    execute(spin_bias_, run_id, name_of(solution.estimate.estimator), prior.name,
            bias.value * to_unit, std::string_view{prior.is_angle ? "deg" : "km"},
            bias.sigma * to_unit, as_flag(bias.observable), as_flag(bias.estimated), t_tai_ns);
  }
}

void BatchWriter::insert(const std::string& run_id, const BatchSolution& solution,
                         const NutationSearch& search) {
  constexpr double kPerHour = 3600.0;
  using Value = std::optional<double>;
  std::array<Value, 8> found{};
  std::optional<std::int64_t> at_tai_ns;
  if (search.found) {
    at_tai_ns = tai_ns(solution.nutation_t);
    const auto& [t_s, half_angle, growth, period, lean, per_turn, others] = *search.found;
    found = {half_angle.value * kDegPerRad,
             half_angle.sigma * kDegPerRad,
             period.value,
             period.sigma,
             growth.value * kPerHour,
             growth.sigma * kPerHour,
             lean.value * kDegPerRad,
             lean.sigma * kDegPerRad};
  }
  const auto& [half_angle, half_angle_sigma, period, period_sigma, growth, growth_sigma, lean,
               lean_sigma] = found;
  execute(spin_nutation_, run_id, tai_ns(solution.estimate.t), as_flag(search.found.has_value()),
          search.false_alarm, search.detectable_rad * kDegPerRad, half_angle, half_angle_sigma,
          period, period_sigma, growth, growth_sigma, lean, lean_sigma, at_tai_ns);
}

void BatchWriter::insert(const std::string& run_id, TaiTime t, const ConingEstimate& coning) {
  using Value = std::optional<double>;
  std::array<Value, 4> found{};
  if (coning.verdict.detected) {
    found = {coning.verdict.tilt_rad * kDegPerRad, coning.tilt_sigma_rad * kDegPerRad,
             coning.verdict.azimuth_rad * kDegPerRad, coning.azimuth_sigma_rad * kDegPerRad};
  }
  const auto& [tilt, tilt_sigma, azimuth, azimuth_sigma] = found;
  execute(spin_coning_, run_id, tai_ns(t), as_flag(coning.verdict.detected),
          coning.verdict.detectable_rad * kDegPerRad, tilt, tilt_sigma, azimuth, azimuth_sigma);
}

}  // namespace spindrift
