/// @file
/// Values of the domain to rows of SQL: the one place that knows both.

#pragma once

#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Statement.h>

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "pipelines/core/expected.h"
#include "pipelines/time/sample_contradiction.h"
#include "services/archive/product_writer.h"
#include "services/archive/records.h"

namespace spindrift {

/// Samples that come again with another value: what the table `contradiction` has. All of it throws
/// SQLite::Exception.
class ContradictionWriter {
 public:
  explicit ContradictionWriter(SQLite::Database& database);

  /// Of a sample of an instant of which the archive has one. If they say different things, both
  /// stand in the table from now on; so does what another source says of such an instant.
  /// @return whether that is all: in the table of its kind nothing is to be changed.
  template <class Value>
  bool see(const ArchiveBatch& batch, const TelemetrySample<Value>& sample);

  /// What has been told of the samples seen since it was taken last.
  std::vector<RunNotice> take_notices() { return std::exchange(notices_, {}); }
  /// A transaction has ended. What it has not stored is told again with its samples, but for the
  /// warning.
  void end_write(bool is_stored);

  /// Which of the values count.
  void settle(const std::string& run_id, const SampleContradiction& contradiction);

 private:
  struct Entry {
    std::string_view kind;
    TaiTime t;
    Origin origin;
    std::int64_t arrival;
  };
  bool is_contested(const std::string& run_id, const Entry& entry);
  std::int64_t first_arrival(const std::string& run_id);
  void add_both(const ArchiveBatch& batch, const Entry& there, const std::string& there_value,
                const Entry& came, const std::string& came_value);
  void add(const ArchiveBatch& batch, const Entry& entry, const std::string& value, bool used,
           std::optional<std::int64_t> arrival);
  void say_rounded(const ArchiveBatch& batch, const Entry& there, const Entry& came);
  void say_once(const ArchiveBatch& batch, std::string_view code, const Entry& there,
                const Entry& came, const char* what);

  std::vector<SQLite::Statement> find_;       ///< In the order of the list of kinds.
  std::vector<SQLite::Statement> take_over_;  ///< Likewise.
  SQLite::Statement find_first_arrival_;
  std::pair<std::string, std::int64_t> first_arrival_;  ///< Of the run that was asked for last.
  SQLite::Statement contested_;
  SQLite::Statement add_;
  SQLite::Statement use_none_;
  SQLite::Statement use_;
  std::map<std::string, bool> said_;  ///< What has been warned of, by kind and run; kept or not.
  std::vector<std::string> said_in_write_;  ///< Of those, what may yet be lost.
  std::vector<RunNotice> notices_;
};

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
  void insert(const ArchiveBatch& batch, const TelemetrySample<Value>& sample, Came came);
  void insert(const std::string& run_id, const OperatorAction& action);
  void insert(const std::string& run_id, const RejectedInput& rejected);
  void insert(const std::string& run_id, const SourceCount& count);
  bool is_live(const std::string& run_id);
  void insert_announced(std::span<const ArchiveBatch> batches);
  void insert_latest_counts(std::span<const ArchiveBatch> batches);

  SQLite::Database& database_;
  SQLite::Statement spacecraft_;
  SQLite::Statement run_;
  SQLite::Statement run_telemetry_;
  SQLite::Statement run_finished_;
  SQLite::Statement run_unfinished_;
  SQLite::Statement run_reach_;
  SQLite::Statement run_mode_;
  std::vector<SQLite::Statement> samples_;  ///< In the order of the list of kinds.
  SQLite::Statement operator_action_;
  SQLite::Statement stream_silence_;
  SQLite::Statement rejected_input_;
  SQLite::Statement source_count_;
  ContradictionWriter contradictions_;
  ProductWriter products_;
  std::unordered_map<std::string, bool> is_live_;  ///< Of runs that were looked up, by run_id.
};

}  // namespace spindrift
