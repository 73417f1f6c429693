/// @file
/// Values of the domain to rows of SQL: the one place that knows both.

#pragma once

#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Statement.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "pipelines/core/expected.h"
#include "services/archive/product_writer.h"
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
  /// A sample: now, or before, to be left out then.
  enum class Came { Now, Before };
  template <class Value>
  void insert(const std::string& run_id, const TelemetrySample<Value>& sample, Came came);
  void insert(const std::string& run_id, const OperatorAction& action);
  void insert(const std::string& run_id, const RejectedInput& rejected);
  void insert(const std::string& run_id, const SourceCount& count);
  void insert_latest_counts(std::span<const ArchiveBatch> batches);

  SQLite::Database& database_;
  SQLite::Statement spacecraft_;
  SQLite::Statement run_;
  SQLite::Statement run_telemetry_;
  SQLite::Statement run_finished_;
  SQLite::Statement run_unfinished_;
  SQLite::Statement run_earliest_;
  std::vector<SQLite::Statement> samples_;  ///< In the order of the list of kinds.
  SQLite::Statement operator_action_;
  SQLite::Statement stream_silence_;
  SQLite::Statement rejected_input_;
  SQLite::Statement source_count_;
  ProductWriter products_;
};

}  // namespace spindrift
