/// @file
/// The taking side of one spacecraft's run: samples in, batches of them for the archive and work
/// for its PassRun out.

#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "services/archive/records.h"
#include "services/archive/stored_pass.h"
#include "services/ingest/sample_batch.h"
#include "services/mission/mission.h"
#include "services/processor/pass_run.h"
#include "services/processor/restart_watch.h"

namespace spindrift {

/// Where the samples of a run come from, kept with it.
struct TelemetrySource {
  std::string mode;       ///< live, process or replay.
  std::string telemetry;  ///< File paths, one a line, or DDS domain and partition.
};

/// Everything that arrived goes to the archive at once, whatever is computed from it and when.
class SpacecraftRun {
 public:
  /// @param mission Of a spinner. @param index Of it among the missions.
  SpacecraftRun(const Mission& mission, const TelemetrySource& source, std::size_t index);

  const std::string& spacecraft_id() const { return spacecraft_id_; }
  const std::string& run_id() const { return run_id_; }
  /// What a stored run must have in common with this one to be continued.
  const RunStart& start() const { return start_; }
  std::int64_t edges_received() const { return edges_received_; }    ///< Duplicates too.
  std::int64_t frames_received() const { return frames_received_; }  ///< Coded ones; likewise.
  std::int64_t inputs_rejected() const { return inputs_rejected_; }

  /// The run itself, before its first sample.
  ArchiveBatch begin();

  /// In place of `begin`: the run is that of `stored` until a sample tells of a new pass.
  void go_on(const StoredPass& stored);

  struct Taken {
    std::vector<ArchiveBatch> batches;
    PassInput input;
  };
  Taken take(SampleBatch samples);

  /// What waited for a sample to tell which pass it belongs to, and none came.
  PassInput finish();

 private:
  template <class Sample>
  void sort(const Sample& sample, std::vector<Sample>& held, std::vector<Sample>& input,
            Taken& out);
  void release_held(PassInput& input);
  void begin_new_pass(Taken& out);
  std::vector<SourceCount> source_counts(
      const std::map<std::string, SequenceCounts>& by_source) const;
  ArchiveBatch batch() const;

  std::string spacecraft_id_;
  std::size_t index_;
  RunStart start_;
  std::string run_id_;
  std::int64_t next_arrival_;
  std::int64_t edges_received_ = 0;
  std::int64_t frames_received_ = 0;
  std::int64_t inputs_rejected_ = 0;
  std::optional<TaiTime> earliest_;
  std::map<std::string, SequenceCounts> counts_before_;  ///< The run's, before the restart.
  std::optional<RestartWatch> restart_;                  ///< Until the pass is known.
  std::vector<Pulse> held_pulses_;                       ///< Meanwhile.
  std::vector<CodedFrame> held_frames_;
  std::int64_t held_arrival_ = 0;  ///< Of the first that is held.
};

}  // namespace spindrift
