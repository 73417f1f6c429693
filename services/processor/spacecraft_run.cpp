#include "services/processor/spacecraft_run.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <cstdint>
#include <iterator>
#include <map>
#include <random>
#include <utility>
#include <vector>

#include "services/clock/wall_clock.h"
#include "services/processor/version.h"

namespace spindrift {
namespace {

/// Unique over all archives that may ever be merged; sorts by time of start.
std::string new_run_id(const std::string& started_utc) {
  std::random_device random;
  return fmt::format("{}-{:08x}{:08x}", started_utc, random(), random());
}

std::vector<SourceCount> source_counts(const std::map<std::string, SequenceCounts>& by_source) {
  std::vector<SourceCount> counts;
  counts.reserve(by_source.size());
  for (const auto& [source, count] : by_source) {
    counts.push_back({.source = source,
                      .received = static_cast<std::int64_t>(count.received),
                      .gaps = static_cast<std::int64_t>(count.missing),
                      .duplicates = static_cast<std::int64_t>(count.duplicates),
                      .disordered = static_cast<std::int64_t>(count.disordered)});
  }
  return counts;
}

}  // namespace

SpacecraftRun::SpacecraftRun(const Mission& mission, const TelemetrySource& source)
    : start_{.spacecraft_kind = std::string{name_of(mission.kind)},
             .mode = source.mode,
             .software_version = kSoftwareVersion,
             .config_toml = mission.toml_text,
             .config_sha256 = mission.sha256,
             .orbit_sha256 = mission.orbit_sha256,
             .telemetry = source.telemetry,
             .started_utc = utc_now()},
      pass_{*mission.spin, *mission.orbit} {
  summary_.run_id = new_run_id(start_.started_utc);
  summary_.spacecraft_id = mission.spacecraft_id;
  for (const std::string& setting : settings_without_effect(*mission.spin)) {
    spdlog::warn("{}: {}", mission.spacecraft_id, setting);
  }
}

ArchiveBatch SpacecraftRun::batch() const {
  ArchiveBatch batch;
  batch.run_id = summary_.run_id;
  batch.spacecraft_id = summary_.spacecraft_id;
  return batch;
}

ArchiveBatch SpacecraftRun::begin() {
  ArchiveBatch first = batch();
  first.start = start_;
  return first;
}

ArchiveBatch SpacecraftRun::take(SampleBatch samples) {
  ArchiveBatch taken = batch();
  summary_.edges_received += static_cast<std::int64_t>(samples.pulses.size());
  summary_.input_rejected += static_cast<std::int64_t>(samples.rejected.size());
  for (const PulseSample& sample : samples.pulses) {
    keep(pass_.push(sample.pulse), taken);
  }
  for (const CodedSample& sample : samples.coded) {
    keep(pass_.push(sample.frame), taken);
  }
  taken.pulses = std::move(samples.pulses);
  taken.rejected = std::move(samples.rejected);
  taken.source_counts = source_counts(samples.counts);
  return taken;
}

ArchiveBatch SpacecraftRun::finish() {
  ArchiveBatch last = batch();
  keep(pass_.finish(), last);
  last.finished_utc = utc_now();
  return last;
}

void SpacecraftRun::keep(SpinOutput output, ArchiveBatch& batch) {
  for (const std::string& notice : output.notices) {
    spdlog::warn("{}: {}", summary_.spacecraft_id, notice);
  }
  for (const SpinProduct& product : output.products) {
    summary_.count(product);
  }
  std::move(output.products.begin(), output.products.end(), std::back_inserter(batch.products));
}

}  // namespace spindrift
