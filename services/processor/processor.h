/// @file
/// The one path of data: samples of all spacecraft in, batches for the archive out. Live, offline
/// and in replay only the source of the samples differs.

#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "pipelines/core/expected.h"
#include "services/archive/records.h"
#include "services/ingest/sample_batch.h"
#include "services/mission/mission.h"
#include "services/processor/spacecraft_run.h"

namespace spindrift {

class Processor {
 public:
  /// @return InvalidConfiguration for a mission that is no spinner, or two of one spacecraft.
  static Expected<Processor> make(const std::vector<Mission>& missions,
                                  const TelemetrySource& source);

  std::vector<ArchiveBatch> begin();

  /// What belongs to no spacecraft, rejected inputs and the counts of the sources, is stored under
  /// the first run only, so that sums over runs hold. A sample of a spacecraft without a mission
  /// here is another service's: it is counted and not stored.
  std::vector<ArchiveBatch> take(SampleBatch samples);

  std::vector<ArchiveBatch> finish();

  std::vector<RunSummary> summaries() const;

  /// Samples of spacecraft without a mission here; beyond 256 of them together, under "(others)".
  const std::map<std::string, std::int64_t>& other_spacecraft() const { return other_spacecraft_; }

 private:
  explicit Processor(std::vector<SpacecraftRun> runs) : runs_{std::move(runs)} {}

  void count_other(const std::string& spacecraft);

  std::vector<SpacecraftRun> runs_;
  std::map<std::string, std::int64_t> other_spacecraft_;
};

}  // namespace spindrift
