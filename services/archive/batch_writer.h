/// @file
/// Writes values of the domain as rows of SQL.

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

/// Writes contradicting samples (table `contradiction`). All of it throws SQLite::Exception.
class ContradictionWriter {
 public:
  explicit ContradictionWriter(SQLite::Database& database);

  /// Checks a sample for whose instant the archive has one. If the two differ, both go into the
  /// table; so does what another source says about an instant that is already in it.
  /// @return Whether the table of the sample's kind needs no change.
  template <class Value>
  bool compare_with_stored(const ArchiveBatch& batch, const ArrivedSample<Value>& sample);

  /// Returns the notices on the samples seen since the last call.
  std::vector<RunNotice> take_notices() { return std::exchange(notices_, {}); }
  /// Ends a transaction. If it was not stored, its notices are given again when its samples come
  /// again, but without a second warning.
  void end_write(bool is_stored);

  /// Marks which of the contradicting values are used.
  void settle(const std::string& run_id, const SampleContradiction& contradiction);

 private:
  struct Entry {
    std::string_view kind;
    TaiTime t;
    Origin origin;
    RunPlace arrival;
  };
  bool is_contested(const std::string& run_id, const Entry& entry);
  RunPlace first_arrival(const std::string& run_id);
  void add_both(const ArchiveBatch& batch, const Entry& there, const std::string& there_value,
                const Entry& came, const std::string& came_value);
  void insert(const ArchiveBatch& batch, const Entry& entry, const std::string& value, bool used,
              std::optional<RunPlace> arrival);
  void say_rounded(const ArchiveBatch& batch, const Entry& there, const Entry& came);
  void say_once(const ArchiveBatch& batch, std::string_view code, const Entry& there,
                const Entry& came, const char* what);

  std::vector<SQLite::Statement> find_;  ///< One per kind of telemetry, in kTelemetryKind order.
  std::vector<SQLite::Statement> take_over_;  ///< Statements in the same order.
  SQLite::Statement find_first_arrival_;
  std::pair<std::string, RunPlace> first_arrival_;  ///< Cached for the run asked for last.
  SQLite::Statement contested_;
  SQLite::Statement add_;
  SQLite::Statement use_none_;
  SQLite::Statement use_;
  /// What was warned of, by code, kind and run; whether the notice is stored.
  std::map<std::string, bool> said_;
  std::vector<std::string> said_in_write_;  ///< Keys in the open transaction.
  std::vector<RunNotice> notices_;
};

/// Holds the prepared statements of one connection. `database` must outlive it.
class BatchWriter {
 public:
  /// @throws SQLite::Exception
  explicit BatchWriter(SQLite::Database& database);

  /// Stores all of `batches` in one transaction, or nothing. @return InvalidInput when a row
  /// violates the schema (a NaN, an unknown run); Unavailable when SQLite cannot write.
  Expected<void> write(std::span<const ArchiveBatch> batches);

 private:
  void insert(const ArchiveBatch& batch);
  void insert(const ArchiveBatch& batch, const RunStart& start);
  /// Whether a sample came now, or came before and was left out then.
  enum class Came { Now, Before };
  template <class Value>
  void insert(const ArchiveBatch& batch, const ArrivedSample<Value>& sample, Came came);
  void insert(const std::string& run_id, const OperatorAction& action);
  void insert(const std::string& run_id, const SourceClock& clock);
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
  std::vector<SQLite::Statement> samples_;  ///< One per kind of telemetry, in kTelemetryKind order.
  SQLite::Statement operator_action_;
  SQLite::Statement stream_silence_;
  SQLite::Statement source_clock_;
  SQLite::Statement rejected_input_;
  SQLite::Statement source_count_;
  ContradictionWriter contradictions_;
  ProductWriter products_;
  std::unordered_map<std::string, bool> is_live_;  ///< Cached answers, by run_id.
};

}  // namespace spindrift
