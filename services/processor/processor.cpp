#include "services/processor/processor.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <utility>

namespace spindrift {
namespace {

Unexpected refused(std::string message) {
  return Unexpected{{ErrorCode::InvalidConfiguration, std::move(message)}};
}

constexpr std::size_t kMaxOthers = 256;
constexpr const char* kOthers = "(others)";

bool is_empty(const SampleBatch& batch) {
  return batch.pulses.empty() && batch.rejected.empty() && batch.counts.empty();
}

}  // namespace

Expected<Processor> Processor::make(const std::vector<Mission>& missions,
                                    const TelemetrySource& source) {
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
    runs.emplace_back(mission, source);
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

std::vector<ArchiveBatch> Processor::take(SampleBatch samples) {
  std::vector<SampleBatch> by_run(runs_.size());
  by_run.front().rejected = std::move(samples.rejected);
  by_run.front().counts = std::move(samples.counts);
  for (PulseSample& sample : samples.pulses) {
    const auto run = std::find_if(runs_.begin(), runs_.end(), [&](const SpacecraftRun& r) {
      return r.summary().spacecraft_id == sample.spacecraft;
    });
    if (run == runs_.end()) {
      count_other(sample.spacecraft);
    } else {
      by_run.at(static_cast<std::size_t>(run - runs_.begin())).pulses.push_back(std::move(sample));
    }
  }
  std::vector<ArchiveBatch> batches;
  for (std::size_t i = 0; i < runs_.size(); ++i) {
    if (!is_empty(by_run[i])) {
      batches.push_back(runs_[i].take(std::move(by_run[i])));
    }
  }
  return batches;
}

std::vector<ArchiveBatch> Processor::finish() {
  std::vector<ArchiveBatch> batches;
  for (SpacecraftRun& run : runs_) {
    batches.push_back(run.finish());
  }
  return batches;
}

void Processor::count_other(const std::string& spacecraft) {
  const bool room = other_spacecraft_.size() < kMaxOthers || other_spacecraft_.contains(spacecraft);
  if (++other_spacecraft_[room ? spacecraft : kOthers] == 1) {
    spdlog::warn("samples of {}, which has no mission file here, are left to others",
                 room ? fmt::format("spacecraft '{}'", spacecraft) : "still more spacecraft");
  }
}

std::vector<RunSummary> Processor::summaries() const {
  std::vector<RunSummary> summaries;
  std::transform(runs_.begin(), runs_.end(), std::back_inserter(summaries),
                 [](const SpacecraftRun& run) { return run.summary(); });
  return summaries;
}

}  // namespace spindrift
