#include "services/archive/batch_writer.h"

#include <SQLiteCpp/Transaction.h>

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>

#include "services/archive/bind.h"
#include "services/archive/connection.h"

namespace spindrift {
namespace {

std::int64_t as_signed(std::uint64_t value) { return static_cast<std::int64_t>(value); }

// What is stored already stays as it is, but for its place in the order of the run that takes it
// now: of ?8, where ?7 is its arrival.
constexpr const char* kTakenByALaterRun =
    " ON CONFLICT DO UPDATE SET arrival = excluded.arrival"
    " WHERE arrival < (SELECT first_arrival FROM run WHERE run_id = ?8)";

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
      run_unfinished_{database, "UPDATE run SET finished_utc = NULL WHERE run_id = ?"},
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
      products_{database} {}

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
    execute(run_unfinished_, batch.run_id);
    products_.withdraw(batch.run_id, batch.continuation->t);
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
  for (const Product& product : batch.products) {
    products_.insert(batch.run_id, batch.spacecraft_id, product);
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

}  // namespace spindrift
