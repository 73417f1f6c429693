/// @file
/// The receiving side of one spacecraft's run: takes samples in and gives batches for the archive
/// and work for the computing side.

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

/// Describes where the samples of a run come from; stored with the run.
struct TelemetrySource {
  RunMode mode;
  std::vector<std::string> telemetry;      ///< Absolute file paths, or DDS domain and partition.
  std::optional<std::string> sha256 = {};  ///< Digest of all bytes of the files.
  std::optional<std::string> label = {};   ///< Label that the user gives the run.
};

struct Received {
  std::array<std::int64_t, kTelemetryKindCount>
      samples{};                 ///< Number of samples by kind, with duplicates.
  std::int64_t frame_edges = 0;  ///< Edges that the coded frames hold.
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

/// Numbers, sorts and stores the samples of one spacecraft. Every sample goes to the archive at
/// once, independently of what is computed from it and when.
/// A new run begins after a silence that ends a pass (PassWatch), or when the time of another
/// source turns out to be right (SourceWatch). It begins in the batch of the sample that decides
/// this; the samples held until then arrive anew, so that the samples of a run are numbered without
/// gaps. Files are read in order of time, whatever source they name.
class SpacecraftRun {
 public:
  SpacecraftRun(const Mission& mission, const TelemetrySource& source, std::size_t index);

  const std::string& spacecraft_id() const { return spacecraft_id_; }
  const std::string& run_id() const { return run_id_; }
  /// Returns the properties that a stored run must share with this one to be continued.
  const RunStart& start() const { return start_; }
  /// @param run_id Id of the current run or of an earlier one.
  Received received(const std::string& run_id) const;

  /// Returns the table of sender numbers, which samples read back from an archive must use too.
  SenderNames& senders() { return senders_; }

  /// Makes new arrivals later than all of the stored run that begins at `first_arrival`.
  void arrive_after(RunPlace first_arrival);

  /// Takes over operator actions of earlier runs, in order of arrival; new runs obey them too.
  void take_up(std::vector<OperatorAction> actions) { actions_ = std::move(actions); }

  struct Taken {
    std::vector<ArchiveBatch> batches;
    std::vector<PassInput> inputs;  ///< May hold empty inputs.
    /// Set by `go_on` only: for each run the time that its pass has reached (PassWatch).
    std::vector<std::optional<TaiTime>> reached = {};
  };
  Taken begin();

  /// Called instead of `begin`: the run begins with the first samples or actions that `receive`
  /// gets.
  /// @param notice Stored with the run when it begins.
  void begin_later(RunNotice notice) { begins_with_ = std::move(notice); }
  bool has_begun() const { return !begins_with_; }

  Taken receive(SampleBatch samples, const Moment& moment);

  /// Inserts a silence among the samples because none came for a while. Does nothing when no sample
  /// has come since the last silence.
  Taken fall_silent();

  /// Called instead of `begin`: brings the runs of `stored`, oldest first, to the state their
  /// samples had brought them to. The last of them is continued.
  Taken go_on(const std::vector<StoredPass>& stored, const Moment& moment);

  /// Looks for sources that have fallen silent, because time has passed since samples were taken.
  Taken decide(const Moment& moment);
  /// Returns when `decide` may have an effect; empty when it has none before the next sample.
  std::optional<std::chrono::steady_clock::time_point> next_decision() const {
    return sources_.next_decision();
  }
  /// Describes the sources that are left out, with the time each was last heard.
  std::vector<SourceProblem> source_problems() const { return notices_.problems(sources_); }

  /// Settles samples that are still held because no later one has shown their pass.
  Taken finish();

 private:
  Taken nothing_taken() const;
  RunPlace new_arrival() { return std::exchange(next_arrival_, place_after(next_arrival_)); }
  template <class Value>
  void sort(TelemetrySample<Value>&& sample, const Moment& moment, Taken& out);
  template <class Value>
  SourceWatch::Verdict judge(const TelemetrySample<Value>& sample, const Moment& moment);
  template <class Value>
  ArrivedSample<Value> arrived(TelemetrySample<Value>&& sample);
  template <class Value>
  void accept(TelemetrySample<Value>&& sample, Taken& out);
  void accept(const TelemetryValues& held, Taken& out);
  void go_on(const StoredPass& stored, Taken& out);
  void restore_sources(const StoredPass& stored, const Moment& moment);
  void decide(const Moment& moment, Taken& out);
  void note_clock(Taken& out);
  void follow(const SourceId& successor, const Moment& moment, Taken& out);
  template <class Value>
  bool is_known(const Value& value);
  template <class Value>
  void place(const Arrived<Value>& arrived, Taken& out);
  template <class Value>
  void hand_on(const Value& value, std::vector<PassInput>& inputs) const;
  static void hand_on(OperatorAction action, std::vector<PassInput>& inputs);
  void hand_on_silence(RunPlace arrival, std::vector<PassInput>& inputs);
  void accept(OperatorAction&& action, Taken& out);
  void repeat_actions_before(RunPlace first_arrival, Taken& out);
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
  std::optional<RunNotice> begins_with_;  ///< Empty once the run has begun.
  RunPlace next_arrival_;
  RunPlace silent_before_;  ///< Arrival that was next at the last silence.
  Received received_;
  std::map<std::string, Received> received_before_;  ///< Counts of the earlier runs, by run_id.
  std::optional<Contact> contact_;
  ReachWatch reach_;
  std::map<std::string, SequenceCounts> latest_counts_;  ///< Counts since the service started.
  std::map<std::string, SequenceCounts> counts_before_;  ///< Counts of the run before a restart.
  std::map<std::string, SequenceCounts> counts_of_earlier_runs_;
  SenderNames senders_;
  RunNotices notices_;
  bool judges_sources_;
  SourceWatch new_sources_;  ///< Of a run that has heard none.
  SourceWatch sources_;
  std::optional<SourceId> leader_;  ///< Whose telemetry the archive knows to be the clock.
  PassWatch watch_;
  std::optional<StoredSamples> stored_;  ///< Set from a restart until the pass goes on.
  TelemetryValues held_;                 ///< Held until their pass is known.
  std::vector<OperatorAction> actions_;  ///< For this run and earlier ones, in order of arrival.
};

}  // namespace spindrift
