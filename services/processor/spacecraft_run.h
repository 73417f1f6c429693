/// @file
/// One spacecraft's run: its samples in, batches for the archive out.

#pragma once

#include <span>
#include <string>
#include <vector>

#include "pipelines/spin/spin_pass.h"
#include "services/archive/records.h"
#include "services/ingest/pulse_batch.h"
#include "services/mission/mission.h"
#include "services/processor/run_summary.h"

namespace spindrift {

/// Every batch holds the samples and what came of them, so that no result is stored, and hence
/// none announced, before the samples that it rests on.
class SpacecraftRun {
 public:
  /// @param mission Of a spinner.
  /// @param mode    live, process or replay.
  SpacecraftRun(const Mission& mission, const std::string& mode);

  /// The run itself, before its first sample.
  ArchiveBatch begin();

  ArchiveBatch take(PulseBatch samples);

  /// The pass has ended: what was still held, the counts of the senders, the end of the run.
  ArchiveBatch finish(std::vector<SourceCount> source_counts);

  const RunSummary& summary() const { return summary_; }

 private:
  ArchiveBatch batch() const;
  void keep(SpinOutput output, ArchiveBatch& batch);

  RunStart start_;
  RunSummary summary_;
  SpinPass pass_;
};

}  // namespace spindrift
