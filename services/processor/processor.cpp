#include "services/processor/processor.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <utility>

namespace spindrift {
namespace {

Unexpected refused(std::string message) {
  return Unexpected{{ErrorCode::InvalidConfiguration, std::move(message)}};
}

RejectedInput without_mission(const PulseSample& sample) {
  return {.source = sample.origin.source,
          .line = static_cast<std::int64_t>(sample.origin.seq),
          .reason = fmt::format("spacecraft '{}' has no mission file here", sample.spacecraft)};
}

}  // namespace

Expected<Processor> Processor::make(const std::vector<Mission>& missions, const std::string& mode) {
  std::set<std::string> seen;
  std::vector<SpacecraftRun> runs;
  for (const Mission& mission : missions) {
    if (!mission.spin) {
      return refused(fmt::format("spacecraft '{}' is of kind {}: this version processes spin only",
                                 mission.spacecraft_id, name_of(mission.kind)));
    }
    if (!seen.insert(mission.spacecraft_id).second) {
      return refused(fmt::format("two mission files name the spacecraft '{}': one is allowed",
                                 mission.spacecraft_id));
    }
    runs.emplace_back(mission, mode);
  }
  return Processor{std::move(runs)};
}

std::vector<ArchiveBatch> Processor::begin() {
  std::vector<ArchiveBatch> batches;
  for (SpacecraftRun& run : runs_) {
    batches.push_back(run.begin());
  }
  return batches;
}

std::vector<ArchiveBatch> Processor::take(PulseBatch samples) {
  std::vector<PulseBatch> by_run(runs_.size());
  by_run.front().rejected = std::move(samples.rejected);
  for (PulseSample& sample : samples.pulses) {
    const auto run = std::find_if(runs_.begin(), runs_.end(), [&](const SpacecraftRun& r) {
      return r.summary().spacecraft_id == sample.spacecraft;
    });
    if (run == runs_.end()) {
      by_run.front().rejected.push_back(without_mission(sample));
    } else {
      by_run.at(static_cast<std::size_t>(run - runs_.begin())).pulses.push_back(std::move(sample));
    }
  }
  std::vector<ArchiveBatch> batches;
  for (std::size_t i = 0; i < runs_.size(); ++i) {
    if (!by_run[i].pulses.empty() || !by_run[i].rejected.empty()) {
      batches.push_back(runs_[i].take(std::move(by_run[i])));
    }
  }
  return batches;
}

std::vector<ArchiveBatch> Processor::finish(const std::vector<SourceCount>& source_counts) {
  std::vector<ArchiveBatch> batches;
  for (SpacecraftRun& run : runs_) {
    batches.push_back(run.finish(source_counts));
  }
  return batches;
}

std::vector<RunSummary> Processor::summaries() const {
  std::vector<RunSummary> summaries;
  std::transform(runs_.begin(), runs_.end(), std::back_inserter(summaries),
                 [](const SpacecraftRun& run) { return run.summary(); });
  return summaries;
}

}  // namespace spindrift
