/// @file
/// One spacecraft's run: its samples in, batches for the archive out.

#pragma once

#include <string>

#include "pipelines/spin/spin_pass.h"
#include "services/archive/records.h"
#include "services/ingest/sample_batch.h"
#include "services/mission/mission.h"
#include "services/processor/run_summary.h"

namespace spindrift {

/// Where the samples of a run come from, kept with it.
struct TelemetrySource {
  std::string mode;       ///< live, process or replay.
  std::string telemetry;  ///< File paths, one a line, or DDS domain and partition.
};

/// Every batch holds the samples and what came of them, so that no result is stored, and hence
/// none announced, before the samples that it rests on.
class SpacecraftRun {
 public:
  /// @param mission Of a spinner.
  SpacecraftRun(const Mission& mission, const TelemetrySource& source);

  /// The run itself, before its first sample.
  ArchiveBatch begin();

  ArchiveBatch take(SampleBatch samples);

  /// The pass has ended: what was still held, and the end of the run.
  ArchiveBatch finish();

  const RunSummary& summary() const { return summary_; }

 private:
  ArchiveBatch batch() const;
  void keep(SpinOutput output, ArchiveBatch& batch);

  RunStart start_;
  RunSummary summary_;
  SpinPass pass_;
};

}  // namespace spindrift
