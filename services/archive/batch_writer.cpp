#include "services/archive/batch_writer.h"

#include <SQLiteCpp/Transaction.h>
#include <fmt/format.h>

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "services/archive/bind.h"
#include "services/archive/connection.h"
#include "services/base/wall_clock.h"

namespace spindrift {
namespace {

std::int64_t as_signed(std::uint64_t value) { return static_cast<std::int64_t>(value); }

/// Inserts a sample. A stored sample stays as it is, except that it gets a place in the order of
/// the run that takes it now (?4). A stored sample that was left out because its source's time was
/// wrong is replaced by one that came now (?5), and replaces none itself. Without a run in ?4 no
/// stored row changes.
template <class Value>
std::string insert_statement() {
  std::vector<std::string_view> names{"source", "session", "seq"};
  std::apply([&](const auto&... column) { (names.emplace_back(column.name), ...); },
             Telemetry<Value>::kColumns);
  std::string columns;
  std::string values;
  std::string updates;
  int parameter = 5;
  for (const std::string_view name : names) {
    columns += fmt::format(", {}", name);
    values += fmt::format(", ?{}", ++parameter);
    updates += fmt::format(", {0} = iif(arrival < 0 AND ?5, excluded.{0}, {0})", name);
  }
  return fmt::format(
      "INSERT INTO {} (spacecraft_id, t_tai_ns, arrival{}) VALUES (?1, ?2, ?3{})"
      " ON CONFLICT DO UPDATE SET arrival = excluded.arrival{}"
      " WHERE arrival < (SELECT first_arrival FROM run WHERE run_id = ?4)"
      " AND (excluded.arrival >= 0 OR arrival < 0)",
      Telemetry<Value>::kTable, columns, values, updates);
}

std::vector<SQLite::Statement> insert_statements(SQLite::Database& database) {
  std::vector<SQLite::Statement> statements;
  TelemetryKinds::for_each([&]<class Value>(Kind<Value> /*kind*/) {
    statements.emplace_back(database, insert_statement<Value>());
  });
  return statements;
}

RunOfProducts run_of(const ArchiveBatch& batch) {
  return {.run_id = batch.run_id,
          .spacecraft_id = batch.spacecraft_id,
          .stores_residuals = batch.stores_residuals};
}

}  // namespace

BatchWriter::BatchWriter(SQLite::Database& database)
    : database_{database},
      spacecraft_{database,
                  "INSERT INTO spacecraft (spacecraft_id, name, kind) VALUES (?1, ?1, ?2)"
                  " ON CONFLICT DO UPDATE SET kind = excluded.kind"},
      run_{database,
           "INSERT INTO run (run_id, spacecraft_id, mode, software_version, config_toml,"
           " config_sha256, config_path, orbit_sha256, telemetry_sha256, label, started_utc,"
           " first_arrival) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)"},
      run_telemetry_{database,
                     "INSERT INTO run_telemetry (run_id, position, telemetry) VALUES (?, ?, ?)"},
      run_finished_{database, "UPDATE run SET finished_utc = ? WHERE run_id = ?"},
      run_unfinished_{database, "UPDATE run SET finished_utc = NULL WHERE run_id = ?"},
      run_reach_{database,
                 "UPDATE run SET first_tai_ns = min(ifnull(first_tai_ns, ?1), ?1),"
                 " last_tai_ns = max(ifnull(last_tai_ns, ?2), ?2), contact_share = ?3"
                 " WHERE run_id = ?4"},
      run_mode_{database, "SELECT mode FROM run WHERE run_id = ?"},
      samples_{insert_statements(database)},
      operator_action_{database,
                       "INSERT INTO operator_action (action_id, spacecraft_id, run_id, arrival,"
                       " t_tai_ns, made_utc, by, action, arguments, note)"
                       " VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?) ON CONFLICT DO NOTHING"},
      stream_silence_{database, "INSERT INTO stream_silence (run_id, arrival) VALUES (?, ?)"},
      source_clock_{database,
                    "INSERT OR REPLACE INTO source_clock (run_id, arrival, source, session)"
                    " VALUES (?, ?, ?, ?)"},
      rejected_input_{database,
                      "INSERT INTO rejected_input (run_id, source, session, line, reason, samples)"
                      " VALUES (?, ?, ?, ?, ?, ?) ON CONFLICT DO NOTHING"},
      source_count_{database,
                    "INSERT OR REPLACE INTO source_count (run_id, source, received, gaps,"
                    " duplicates, disordered) VALUES (?, ?, ?, ?, ?, ?)"},
      contradictions_{database},
      products_{database} {}

Expected<void> BatchWriter::write(std::span<const ArchiveBatch> batches) {
  try {
    SQLite::Transaction transaction{database_, SQLite::TransactionBehavior::IMMEDIATE};
    for (const ArchiveBatch& batch : batches) {
      insert(batch);
    }
    insert_latest_counts(batches);
    insert_announced(batches);
    transaction.commit();
    contradictions_.end_write(true);
    return {};
  } catch (const SQLite::Exception& exception) {
    contradictions_.end_write(false);
    return Unexpected{archive_error(database_.getFilename(), exception)};
  }
}

void BatchWriter::insert(const ArchiveBatch& batch) {
  if (batch.start) {
    insert(batch, *batch.start);
  }
  if (batch.continuation) {
    execute(run_unfinished_, batch.run_id);
    products_.withdraw(batch.run_id, batch.continuation->t);
  }
  if (batch.reach) {
    execute(run_reach_, tai_ns(batch.reach->first), tai_ns(batch.reach->last),
            batch.reach->contact_share, batch.run_id);
  }
  batch.samples.for_each([&](const auto& of_kind) {
    for (const auto& sample : of_kind) {
      insert(batch, sample, Came::Now);
    }
  });
  batch.moved.for_each([&]<class Value>(const std::vector<Arrived<Value>>& of_kind) {
    for (const auto& [arrival, value] : of_kind) {
      insert(
          batch,
          ArrivedSample<Value>{
              .spacecraft = batch.spacecraft_id, .origin = {}, .value = value, .arrival = arrival},
          Came::Before);
    }
  });
  for (const RunNotice& notice : contradictions_.take_notices()) {
    products_.insert(run_of(batch), std::nullopt, notice);
  }
  for (const OperatorAction& action : batch.actions) {
    insert(batch.run_id, action);
  }
  for (const RunPlace arrival : batch.silences) {
    execute(stream_silence_, batch.run_id, arrival);
  }
  for (const SourceClock& clock : batch.clocks) {
    insert(batch.run_id, clock);
  }
  for (const RejectedInput& rejected : batch.rejected) {
    insert(batch.run_id, rejected);
  }
  for (const Product& product : batch.products) {
    if (const auto* const contradiction = std::get_if<SampleContradiction>(&product)) {
      contradictions_.settle(batch.run_id, *contradiction);
    } else if (!ProductWriter::says_when_announced(product)) {
      products_.insert(run_of(batch), std::nullopt, product);
    }
  }
  if (batch.finished_utc) {
    execute(run_finished_, *batch.finished_utc, batch.run_id);
  }
}

/// Inserts announced products last, so that the time in them is as close to the commit as possible.
void BatchWriter::insert_announced(std::span<const ArchiveBatch> batches) {
  const std::string now = utc_now();
  for (const ArchiveBatch& batch : batches) {
    for (const Product& product : batch.products) {
      if (ProductWriter::says_when_announced(product)) {
        products_.insert(run_of(batch), is_live(batch.run_id) ? std::optional{now} : std::nullopt,
                         product);
      }
    }
  }
}

bool BatchWriter::is_live(const std::string& run_id) {
  const auto known = is_live_.find(run_id);
  if (known != is_live_.end()) {
    return known->second;
  }
  run_mode_.tryReset();
  run_mode_.bind(1, run_id);
  const bool live =
      run_mode_.executeStep() && run_mode_.getColumn(0).getString() == name_of(RunMode::Live);
  run_mode_.reset();
  return is_live_.emplace(run_id, live).first->second;
}

// Each batch has cumulative counts, so only the last counts of a transaction are stored.
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
  execute(spacecraft_, batch.spacecraft_id, name_of(start.spacecraft_kind));
  execute(run_, batch.run_id, batch.spacecraft_id, name_of(start.mode), start.software_version,
          start.config_toml, start.config_sha256, start.config_path, start.orbit_sha256,
          start.telemetry_sha256, start.label, start.started_utc, start.first_arrival);
  std::int64_t position = 0;
  for (const std::string& telemetry : start.telemetry) {
    execute(run_telemetry_, batch.run_id, ++position, telemetry);
  }
}

template <class Value>
void BatchWriter::insert(const ArchiveBatch& batch, const ArrivedSample<Value>& sample, Came came) {
  const std::int64_t arrival = sample.is_left_out ? -sample.arrival.number : sample.arrival.number;
  const auto store = [&](const std::string& run_id) {
    std::apply(
        [&](const auto&... column) {
          execute(samples_[kTelemetryKind<Value>], sample.spacecraft, tai_ns(sample.value.t),
                  arrival, run_id, std::int64_t{came == Came::Now}, sample.origin.source,
                  as_signed(sample.origin.session), as_signed(sample.origin.seq),
                  column.of(sample.value)...);
        },
        Telemetry<Value>::kColumns);
  };
  if constexpr (HasSender<Value>) {
    if (!sample.is_left_out) {
      store({});
      if (database_.getChanges() > 0 || contradictions_.compare_with_stored(batch, sample)) {
        return;
      }
    }
  }
  store(batch.run_id);
}

void BatchWriter::insert(const std::string& run_id, const OperatorAction& action) {
  execute(operator_action_, action.action_id, action.spacecraft, run_id, action.arrival,
          tai_ns(action.t.value()), action.made_utc, action.by, action.action, action.arguments,
          action.note);
}

void BatchWriter::insert(const std::string& run_id, const SourceClock& clock) {
  std::optional<std::string> source;
  std::optional<std::int64_t> session;
  if (clock.source) {
    source = clock.source->source;
    session = static_cast<std::int64_t>(clock.source->session);
  }
  execute(source_clock_, run_id, clock.arrival, source, session);
}

void BatchWriter::insert(const std::string& run_id, const RejectedInput& rejected) {
  execute(rejected_input_, run_id, rejected.source, as_signed(rejected.session), rejected.line,
          rejected.reason, rejected.samples);
}

void BatchWriter::insert(const std::string& run_id, const SourceCount& count) {
  execute(source_count_, run_id, count.source, count.received, count.gaps, count.duplicates,
          count.disordered);
}

}  // namespace spindrift
