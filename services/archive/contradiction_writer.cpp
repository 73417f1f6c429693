#include <fmt/format.h>

#include "pipelines/time/utc.h"
#include "services/archive/batch_writer.h"
#include "services/archive/bind.h"
#include "services/archive/stored_rows.h"
#include "services/base/warning.h"
#include "services/products/notice_of.h"
#include "services/telemetry/by_kind.h"
#include "services/telemetry/sample_json.h"

namespace spindrift {
namespace {

template <class Make>
std::vector<SQLite::Statement> of_each_kind(SQLite::Database& database, const Make& make) {
  std::vector<SQLite::Statement> statements;
  TelemetryKinds::for_each(
      [&]<class Value>(Kind<Value> kind) { statements.emplace_back(database, make(kind)); });
  return statements;
}

}  // namespace

ContradictionWriter::ContradictionWriter(SQLite::Database& database)
    : find_{of_each_kind(database,
                         []<class Value>(Kind<Value> /*kind*/) {
                           return fmt::format(
                               "SELECT {}, source, session, seq FROM {}"
                               " WHERE spacecraft_id = ? AND t_tai_ns = ?",
                               arrived_columns<Value>(), Telemetry<Value>::kTable);
                         })},
      take_over_{of_each_kind(database,
                              []<class Value>(Kind<Value> /*kind*/) {
                                return fmt::format(
                                    "UPDATE {} SET source = ?3, session = ?4, seq = ?5"
                                    " WHERE spacecraft_id = ?1 AND t_tai_ns = ?2",
                                    Telemetry<Value>::kTable);
                              })},
      find_first_arrival_{database, "SELECT first_arrival FROM run WHERE run_id = ?"},
      contested_{database,
                 "SELECT EXISTS (SELECT 1 FROM contradiction WHERE run_id = ? AND kind = ?"
                 " AND t_tai_ns = ?)"},
      add_{database,
           "INSERT INTO contradiction (run_id, spacecraft_id, kind, t_tai_ns, source, session, seq,"
           " value, used, arrival) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?) ON CONFLICT DO NOTHING"},
      use_none_{database,
                "UPDATE contradiction SET used = 0 WHERE run_id = ? AND kind = ? AND t_tai_ns = ?"},
      use_{database,
           "UPDATE contradiction SET used = 1 WHERE run_id = ? AND kind = ? AND t_tai_ns = ?"
           " AND source = ?"} {}

template <class Value>
bool ContradictionWriter::compare_with_stored(const ArchiveBatch& batch,
                                              const ArrivedSample<Value>& sample) {
  SQLite::Statement& find = find_[kTelemetryKind<Value>];
  find.tryReset();
  find.bindNoCopy(1, sample.spacecraft);
  find.bind(2, tai_ns(sample.value.t));
  find.executeStep();
  const Arrived<Value> stored = read_arrived<Value>(find);
  const bool is_left_out = is_row_left_out(find);
  const int origin = find.getColumnCount() - 3;
  const Entry there{
      .kind = contradiction_kind<Value>(),
      .t = stored.value.t,
      .origin = {.source = find.getColumn(origin).getString(),
                 .session = static_cast<std::uint64_t>(find.getColumn(origin + 1).getInt64()),
                 .seq = static_cast<std::uint64_t>(find.getColumn(origin + 2).getInt64())},
      .arrival = stored.arrival};
  find.reset();
  if (is_left_out) {
    return false;  // Left out because its source's time is wrong, so its real instant is another.
  }
  const Entry came{
      .kind = there.kind, .t = there.t, .origin = sample.origin, .arrival = sample.arrival};
  if (say_the_same(stored.value, sample.value)) {
    const bool is_of_run = there.arrival >= first_arrival(batch.run_id);
    if (came.origin.source == there.origin.source) {
      return is_of_run;
    }
    if (is_of_run && json_of_sample(stored.value) != json_of_sample(sample.value)) {
      say_rounded(batch, there, came);
    }
    if (is_contested(batch.run_id, there)) {
      insert(batch, came, json_of_sample(sample.value), false, came.arrival);
    } else if (came.origin.source == batch.preferred_source) {
      SQLite::Statement& take_over = take_over_[kTelemetryKind<Value>];
      execute(take_over, sample.spacecraft, tai_ns(there.t), came.origin.source,
              static_cast<std::int64_t>(came.origin.session),
              static_cast<std::int64_t>(came.origin.seq));
    }
    return is_of_run;
  }
  add_both(batch, there, json_of_sample(stored.value), came, json_of_sample(sample.value));
  return true;
}

template bool ContradictionWriter::compare_with_stored(const ArchiveBatch&,
                                                       const ArrivedSample<CodedFrame>&);
template bool ContradictionWriter::compare_with_stored(const ArchiveBatch&,
                                                       const ArrivedSample<GyroSample>&);
template bool ContradictionWriter::compare_with_stored(const ArchiveBatch&,
                                                       const ArrivedSample<StarFix>&);
template bool ContradictionWriter::compare_with_stored(const ArchiveBatch&,
                                                       const ArrivedSample<SunDirection>&);
template bool ContradictionWriter::compare_with_stored(const ArchiveBatch&,
                                                       const ArrivedSample<MagneticField>&);
template bool ContradictionWriter::compare_with_stored(const ArchiveBatch&,
                                                       const ArrivedSample<TimedOrbitState>&);

void ContradictionWriter::settle(const std::string& run_id,
                                 const SampleContradiction& contradiction) {
  if (contradiction.late) {
    return;
  }
  execute(use_none_, run_id, contradiction.kind, tai_ns(contradiction.t));
  for (const SampleContradiction::By& by : contradiction.by) {
    if (by.used) {
      execute(use_, run_id, contradiction.kind, tai_ns(contradiction.t), by.name);
    }
  }
}

bool ContradictionWriter::is_contested(const std::string& run_id, const Entry& entry) {
  contested_.tryReset();
  bind(contested_, 1, run_id);
  bind(contested_, 2, entry.kind);
  bind(contested_, 3, tai_ns(entry.t));
  contested_.executeStep();
  const bool is_contested = contested_.getColumn(0).getInt() != 0;
  contested_.reset();
  return is_contested;
}

RunPlace ContradictionWriter::first_arrival(const std::string& run_id) {
  if (first_arrival_.first != run_id) {
    find_first_arrival_.tryReset();
    bind(find_first_arrival_, 1, run_id);
    find_first_arrival_.executeStep();
    first_arrival_ = {run_id, {find_first_arrival_.getColumn(0).getInt64()}};
    find_first_arrival_.reset();
  }
  return first_arrival_.second;
}

/// Adds both values. The first one stays used until the pass decides otherwise. A sample that an
/// earlier run took counts as not come in this run, because its pass cannot know it.
void ContradictionWriter::add_both(const ArchiveBatch& batch, const Entry& there,
                                   const std::string& there_value, const Entry& came,
                                   const std::string& came_value) {
  const bool is_of_run = there.arrival >= first_arrival(batch.run_id);
  const bool is_first = !is_of_run && !is_contested(batch.run_id, there);
  insert(batch, there, there_value, is_of_run, std::nullopt);
  insert(batch, came, came_value, is_first, came.arrival);
  if (is_first) {
    say_once(batch, "contradicts_earlier_run", there, came,
             "samples have other values than an earlier run has of their time, there from {0}, "
             "here from {1}. This run uses its own; one of the two is wrong. Process both in one "
             "run, and see the table contradiction");
  }
}

void ContradictionWriter::say_rounded(const ArchiveBatch& batch, const Entry& there,
                                      const Entry& came) {
  say_once(batch, "rounded", there, came,
           "samples come from {0} and from {1}, of one of them with fewer digits. They are one "
           "sample, and what came first is used");
}

/// @param what Format string with {0} and {1} for the two sources.
void ContradictionWriter::say_once(const ArchiveBatch& batch, std::string_view code,
                                   const Entry& there, const Entry& came, const char* what) {
  const auto [said, is_first] =
      said_.try_emplace(fmt::format("{} {} {}", code, came.kind, batch.run_id), false);
  if (std::exchange(said->second, true)) {
    return;
  }
  said_in_write_.push_back(said->first);
  const nlohmann::json values{{"spacecraft", batch.spacecraft_id},
                              {"kind", came.kind},
                              {"t_tai_ns", tai_ns(came.t)},
                              {"sources", {there.origin.source, came.origin.source}}};
  const std::string text = fmt::format(
      "{}: {} {}; first at {}", batch.spacecraft_id, came.kind,
      fmt::format(fmt::runtime(what), there.origin.source, came.origin.source), format_utc(came.t));
  if (is_first) {
    warn(code, values, text);
  }
  notices_.push_back(notice_of(code, values, text, came.t));
}

void ContradictionWriter::end_write(bool is_stored) {
  for (const std::string& said : std::exchange(said_in_write_, {})) {
    said_[said] = is_stored;
  }
  notices_.clear();
}

void ContradictionWriter::insert(const ArchiveBatch& batch, const Entry& entry,
                                 const std::string& value, bool used,
                                 std::optional<RunPlace> arrival) {
  execute(add_, batch.run_id, batch.spacecraft_id, entry.kind, tai_ns(entry.t), entry.origin.source,
          static_cast<std::int64_t>(entry.origin.session),
          static_cast<std::int64_t>(entry.origin.seq), value, used, arrival);
}

}  // namespace spindrift
