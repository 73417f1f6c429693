/// @file
/// Values of the domain to rows of SQL: the one place that knows both.

#pragma once

#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Statement.h>

#include <cstdint>
#include <span>

#include "pipelines/core/expected.h"
#include "services/archive/records.h"

namespace spindrift {

/// The prepared statements of one connection. `database` must outlive it.
class BatchWriter {
 public:
  /// @throws SQLite::Exception
  explicit BatchWriter(SQLite::Database& database);

  /// Stores all of `batches` in one transaction, or nothing.
  /// @return InvalidInput when a row breaks a rule of the schema (a NaN, an unknown run);
  ///         Unavailable when SQLite cannot write.
  Expected<void> write(std::span<const ArchiveBatch> batches);

 private:
  void insert(const ArchiveBatch& batch);
  void insert(const ArchiveBatch& batch, const RunStart& start);
  void withdraw(const ArchiveBatch& batch, TaiTime from);
  void insert(const ArchiveBatch& batch, const PulseSample& sample, std::int64_t arrival);
  void insert(const ArchiveBatch& batch, const CodedSample& sample, std::int64_t arrival);
  void insert(const std::string& run_id, const RejectedInput& rejected);
  void insert(const std::string& run_id, const SourceCount& count);
  void insert_latest_counts(std::span<const ArchiveBatch> batches);
  void insert(const ArchiveBatch& batch, const PulseUse& use);
  void insert(const ArchiveBatch& batch, const RevolutionProduct& revolution);
  void insert(const ArchiveBatch& batch, const SpinMeasurement& measurement);
  void insert(const ArchiveBatch& batch, const SpinFix& fix);
  void insert_candidates(const ArchiveBatch& batch, const SpinFix& fix);
  void insert(const ArchiveBatch& batch, const SpinEstimate& estimate);
  void insert(const std::string& run_id, const BatchSolution& solution);
  void insert_observability(const std::string& run_id, const BatchSolution& solution);
  void insert_biases(const std::string& run_id, const BatchSolution& solution);
  void insert(const std::string& run_id, const BatchSolution& solution,
              const NutationSearch& search);
  void insert(const std::string& run_id, TaiTime t, const ConingEstimate& coning);

  SQLite::Database& database_;
  SQLite::Statement spacecraft_;
  SQLite::Statement run_;
  SQLite::Statement run_telemetry_;
  SQLite::Statement run_finished_;
  SQLite::Statement run_earliest_;
  SQLite::Statement pulse_;
  SQLite::Statement coded_frame_;
  SQLite::Statement rejected_input_;
  SQLite::Statement source_count_;
  SQLite::Statement pulse_use_;
  SQLite::Statement revolution_;
  SQLite::Statement spin_measurement_;
  SQLite::Statement spin_fix_;
  SQLite::Statement spin_fix_candidates_gone_;
  SQLite::Statement spin_fix_candidate_;
  SQLite::Statement spin_estimate_;
  SQLite::Statement spin_batch_;
  SQLite::Statement spin_batch_singular_value_;
  SQLite::Statement spin_batch_undetermined_;
  SQLite::Statement spin_biases_gone_;
  SQLite::Statement spin_bias_;
  SQLite::Statement spin_nutation_;
  SQLite::Statement spin_coning_;
};

}  // namespace spindrift
