/// @file
/// The one path of data: samples of all spacecraft in, batches for the archive out. Live, offline
/// and in replay only the source of the samples differs.

#pragma once

#include <string>
#include <vector>

#include "pipelines/core/expected.h"
#include "services/archive/records.h"
#include "services/ingest/pulse_batch.h"
#include "services/mission/mission.h"
#include "services/processor/spacecraft_run.h"

namespace spindrift {

class Processor {
 public:
  /// @return InvalidConfiguration for a mission that is no spinner, or two of one spacecraft.
  static Expected<Processor> make(const std::vector<Mission>& missions, const std::string& mode);

  std::vector<ArchiveBatch> begin();

  /// A sample of a spacecraft without a mission is a rejected input of the first run.
  std::vector<ArchiveBatch> take(PulseBatch samples);

  std::vector<ArchiveBatch> finish(const std::vector<SourceCount>& source_counts);

  std::vector<RunSummary> summaries() const;

 private:
  explicit Processor(std::vector<SpacecraftRun> runs) : runs_{std::move(runs)} {}

  std::vector<SpacecraftRun> runs_;
};

}  // namespace spindrift
