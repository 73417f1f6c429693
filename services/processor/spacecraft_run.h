/// @file
/// The taking side of one spacecraft's run: samples in, batches of them for the archive and work
/// for its computing side out.

#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "services/archive/records.h"
#include "services/archive/stored_pass.h"
#include "services/mission/mission.h"
#include "services/processor/pass_watch.h"
#include "services/processor/problems.h"
#include "services/processor/reach_watch.h"
#include "services/processor/run_notices.h"
#include "services/processor/source_watch.h"
#include "services/processor/spin_run.h"
#include "services/processor/stored_samples.h"
#include "services/telemetry/sample_batch.h"
#include "services/telemetry/sender_names.h"

namespace spindrift {

/// Where the samples of a run come from, kept with it.
struct TelemetrySource {
  RunMode mode;
  std::vector<std::string> telemetry;      ///< Absolute paths, or DDS domain and partition.
  std::optional<std::string> sha256 = {};  ///< Of all bytes of the files.
  std::optional<std::string> label = {};   ///< That somebody gives the run.
};

/// What arrived of a run.
struct Received {
  std::array<std::int64_t, kTelemetryKindCount> samples{};  ///< By kind; duplicates too.
  std::int64_t frame_edges = 0;                             ///< That coded frames hold.
  std::int64_t rejected_inputs = 0;

  template <class Value>
  std::int64_t of() const {
    return samples[kTelemetryKind<Value>];
  }
  template <class Value>
  void count(const Value& value, std::int64_t times = 1) {
    samples[kTelemetryKind<Value>] += times;
    if constexpr (std::is_same_v<Value, CodedFrame>) {
      frame_edges += times * static_cast<std::int64_t>(edges_of(value).size());
    }
  }
};

/// Everything that arrived goes to the archive at once, whatever is computed from it and when.
/// After a silence that ends a pass (PassWatch), or when the time of another source is the right
/// one (SourceWatch), what arrives is of a new run. A run begins in the batch of the sample that
/// makes its first ones accepted; they have a place in the order of arrival again, so that the
/// samples of a run have one without gaps. Files are read in order of time, whatever source they
/// name.
class SpacecraftRun {
 public:
  /// @param index Of the mission among all.
  SpacecraftRun(const Mission& mission, const TelemetrySource& source, std::size_t index);

  const std::string& spacecraft_id() const { return spacecraft_id_; }
  const std::string& run_id() const { return run_id_; }
  /// What a stored run must have in common with this one to be continued.
  const RunStart& start() const { return start_; }
  /// @param run_id Of the run, or of one before it.
  Received received(const std::string& run_id) const;

  /// What it reads back from an archive has numbers of these.
  SenderNames& senders() { return senders_; }

  /// The archive holds a run that began so: what a new one takes is later than all of that run.
  void arrive_after(std::int64_t first_arrival);

  /// What operators have said to runs of the same mode, in order of arrival: those to come obey it.
  void take_up(std::vector<OperatorAction> actions) { actions_ = std::move(actions); }

  struct Taken {
    std::vector<ArchiveBatch> batches;
    std::vector<PassInput> inputs;  ///< Some may be empty.
    /// Of `go_on`, run by run: how far its pass has come, see PassWatch.
    std::vector<std::optional<TaiTime>> reached = {};
  };
  /// The run itself, before its first sample.
  Taken begin();

  /// In place of `begin`: with the first of what `take` gets to store. @param notice Of the run.
  void begin_later(RunNotice notice) { begins_with_ = std::move(notice); }
  bool has_begun() const { return !begins_with_; }

  Taken take(SampleBatch samples, const Moment& moment);

  /// Nothing came for a while: a silence among the samples. None when none has come since the last.
  Taken fall_silent();

  /// In place of `begin`: the runs of `stored`, oldest first, at the point to which their samples
  /// brought them. The last of them is the one that goes on.
  Taken go_on(const std::vector<StoredPass>& stored, const Moment& moment);

  /// Time has gone by since samples were taken: sources may have fallen silent.
  Taken decide(const Moment& moment);
  /// When that may tell something.
  std::optional<std::chrono::steady_clock::time_point> next_decision() const {
    return sources_.next_decision();
  }
  /// Sources that are left out, in words, and when each was heard last.
  std::vector<SourceProblem> source_problems() const { return notices_.problems(sources_); }

  /// What waited for a sample to tell which pass it belongs to, and none came.
  Taken finish();

 private:
  Taken nothing_taken() const;
  template <class Value>
  void sort(TelemetrySample<Value>&& sample, const Moment& moment, Taken& out);
  template <class Value>
  SourceWatch::Verdict judge(const TelemetrySample<Value>& sample, const Moment& moment);
  template <class Value>
  void accept(TelemetrySample<Value>&& sample, Taken& out);
  void accept(const TelemetryValues& held, Taken& out);
  void go_on(const StoredPass& stored, const Moment& moment, Taken& out);
  void restore_sources(const StoredPass& stored, const Moment& moment);
  void decide(const Moment& moment, Taken& out);
  void follow(const SourceId& successor, Taken& out);
  template <class Value>
  bool is_known(const Value& value);
  template <class Value>
  void place(const Arrived<Value>& arrived, Taken& out);
  template <class Value>
  void hand_on(const Value& value, std::vector<PassInput>& inputs) const;
  static void hand_on(OperatorAction action, std::vector<PassInput>& inputs);
  void hand_on_silence(std::int64_t arrival, std::vector<PassInput>& inputs);
  void accept(OperatorAction&& action, Taken& out);
  void repeat_actions_before(std::int64_t first_arrival, Taken& out);
  void release_held(std::vector<PassInput>& inputs);
  void note_reach(ArchiveBatch& batch);
  void end_reach(ArchiveBatch& batch);
  Taken begin_with(SampleBatch& samples);
  void begin_new_pass(const TelemetryValues& its_first, Taken& out);
  void begin_new_pass_of_held(Taken& out);
  std::vector<SourceCount> source_counts(const std::map<std::string, SequenceCounts>& by_source);
  ArchiveBatch batch() const;

  std::string spacecraft_id_;
  std::size_t index_;
  RunStart start_;
  std::vector<std::string> orbit_doubts_;
  std::string run_id_;
  std::optional<RunNotice> begins_with_;  ///< Empty: it has begun.
  std::int64_t next_arrival_;
  std::int64_t silent_before_;  ///< The arrival before which it was silent last.
  Received received_;
  std::map<std::string, Received> received_before_;  ///< Of the earlier runs, by run_id.
  std::optional<Contact> contact_;
  ReachWatch reach_;
  std::map<std::string, SequenceCounts> latest_counts_;  ///< Since the service started.
  std::map<std::string, SequenceCounts> counts_before_;  ///< The run's, before a restart.
  std::map<std::string, SequenceCounts> counts_of_earlier_runs_;
  SenderNames senders_;
  RunNotices notices_;
  bool judges_sources_;
  Pace pace_;
  SourceWatch sources_;
  PassWatch watch_;
  std::optional<StoredSamples> stored_;  ///< After a restart, until the pass has gone on.
  TelemetryValues held_;                 ///< Until the pass is known.
  std::vector<OperatorAction> actions_;  ///< To this run and those before it, in order of arrival.
};

}  // namespace spindrift
