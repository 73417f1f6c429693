#include "services/processor/spacecraft_run.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <random>
#include <type_traits>
#include <utility>

#include "services/clock/wall_clock.h"
#include "services/processor/version.h"

namespace spindrift {
namespace {

/// Unique over all archives that may ever be merged; sorts by time of start.
std::string new_run_id(const std::string& started_utc) {
  std::random_device random;
  return fmt::format("{}-{:08x}{:08x}", started_utc, random(), random());
}

SequenceCounts counts_of(const SourceCount& count) {
  return {.received = static_cast<std::uint64_t>(count.received),
          .missing = static_cast<std::uint64_t>(count.gaps),
          .duplicates = static_cast<std::uint64_t>(count.duplicates),
          .disordered = static_cast<std::uint64_t>(count.disordered)};
}

void lower(std::optional<TaiTime>& earliest, TaiTime t) {
  earliest = std::min(earliest.value_or(t), t);
}

}  // namespace

SpacecraftRun::SpacecraftRun(const Mission& mission, const TelemetrySource& source,
                             std::size_t index)
    : spacecraft_id_{mission.spacecraft_id},
      index_{index},
      start_{.spacecraft_kind = std::string{name_of(mission.kind)},
             .mode = source.mode,
             .software_version = kSoftwareVersion,
             .config_toml = mission.toml_text,
             .config_sha256 = mission.sha256,
             .orbit_sha256 = mission.orbit_sha256,
             .telemetry = source.telemetry,
             .started_utc = utc_now(),
             // The clock only sets the run apart from earlier ones; within it samples are counted.
             .first_arrival = tai_ns(tai_now())},
      run_id_{new_run_id(start_.started_utc)},
      next_arrival_{start_.first_arrival} {
  for (const std::string& setting : settings_without_effect(*mission.spin)) {
    spdlog::warn("{}: {}", mission.spacecraft_id, setting);
  }
}

ArchiveBatch SpacecraftRun::batch() const {
  ArchiveBatch batch;
  batch.run_id = run_id_;
  batch.spacecraft_id = spacecraft_id_;
  return batch;
}

ArchiveBatch SpacecraftRun::begin() {
  ArchiveBatch first = batch();
  first.start = start_;
  return first;
}

void SpacecraftRun::go_on(const StoredPass& stored) {
  run_id_ = stored.run_id;
  const auto arrival_of = [](const auto& samples) {
    return samples.empty() ? 0 : samples.back().arrival;
  };
  next_arrival_ =
      std::max({next_arrival_, arrival_of(stored.pulses) + 1, arrival_of(stored.frames) + 1});
  edges_received_ = static_cast<std::int64_t>(stored.pulses.size());
  frames_received_ = static_cast<std::int64_t>(stored.frames.size());
  inputs_rejected_ = stored.rejected_inputs;
  earliest_ = stored.earliest;
  for (const SourceCount& count : stored.source_counts) {
    counts_before_.emplace(count.source, counts_of(count));
  }
  restart_.emplace(stored);
}

SpacecraftRun::Taken SpacecraftRun::take(SampleBatch samples) {
  Taken out;
  out.input.spacecraft = index_;
  const std::int64_t arrival = next_arrival_;
  const auto earliest_before = earliest_;
  inputs_rejected_ += static_cast<std::int64_t>(samples.rejected.size());
  for (const PulseSample& sample : samples.pulses) {
    sort(sample.pulse, held_pulses_, out.input.pulses, out);
  }
  for (const CodedSample& sample : samples.coded) {
    sort(sample.frame, held_frames_, out.input.frames, out);
  }
  out.input.run_id = run_id_;

  ArchiveBatch taken = batch();
  taken.arrival = arrival;
  if (earliest_ != earliest_before) {
    taken.earliest = earliest_;
  }
  taken.pulses = std::move(samples.pulses);
  taken.coded = std::move(samples.coded);
  taken.rejected = std::move(samples.rejected);
  taken.source_counts = source_counts(samples.counts);
  out.batches.push_back(std::move(taken));
  return out;
}

PassInput SpacecraftRun::finish() {
  PassInput rest{.spacecraft = index_, .run_id = run_id_};
  restart_.reset();
  release_held(rest);
  return rest;
}

template <class Sample>
void SpacecraftRun::sort(const Sample& sample, std::vector<Sample>& held,
                         std::vector<Sample>& input, Taken& out) {
  const std::int64_t arrival = next_arrival_++;
  ++(std::is_same_v<Sample, Pulse> ? edges_received_ : frames_received_);
  lower(earliest_, sample.t);
  const auto verdict = restart_ ? restart_->see(sample) : RestartWatch::Verdict::SamePass;
  if (verdict == RestartWatch::Verdict::Stored) {
    return;
  }
  if (verdict == RestartWatch::Verdict::SamePass) {
    if (restart_) {
      restart_.reset();
      release_held(out.input);
    }
    input.push_back(sample);
    return;
  }
  if (held_pulses_.empty() && held_frames_.empty()) {
    held_arrival_ = arrival;
  }
  held.push_back(sample);
  if (verdict == RestartWatch::Verdict::NewPass) {
    begin_new_pass(out);
  }
}

void SpacecraftRun::release_held(PassInput& input) {
  input.pulses.insert(input.pulses.end(), held_pulses_.begin(), held_pulses_.end());
  input.frames.insert(input.frames.end(), held_frames_.begin(), held_frames_.end());
  held_pulses_ = {};
  held_frames_ = {};
}

void SpacecraftRun::begin_new_pass(Taken& out) {
  restart_.reset();
  counts_before_.clear();
  inputs_rejected_ = 0;
  edges_received_ = static_cast<std::int64_t>(held_pulses_.size());
  frames_received_ = static_cast<std::int64_t>(held_frames_.size());
  earliest_.reset();
  for (const Pulse& pulse : held_pulses_) {
    lower(earliest_, pulse.t);
  }
  for (const CodedFrame& frame : held_frames_) {
    lower(earliest_, frame.t);
  }
  release_held(out.input);
  start_.started_utc = utc_now();
  start_.first_arrival = held_arrival_;
  run_id_ = new_run_id(start_.started_utc);
  ArchiveBatch first = begin();
  first.earliest = earliest_;
  out.batches.push_back(std::move(first));
  spdlog::info("{}: more than an hour of silence, a new run begins: {}", spacecraft_id_, run_id_);
}

std::vector<SourceCount> SpacecraftRun::source_counts(
    const std::map<std::string, SequenceCounts>& by_source) const {
  std::vector<SourceCount> counts;
  counts.reserve(by_source.size());
  for (const auto& [source, since_restart] : by_source) {
    const auto before = counts_before_.find(source);
    SequenceCounts count = before == counts_before_.end() ? SequenceCounts{} : before->second;
    count += since_restart;
    counts.push_back({.source = source,
                      .received = static_cast<std::int64_t>(count.received),
                      .gaps = static_cast<std::int64_t>(count.missing),
                      .duplicates = static_cast<std::int64_t>(count.duplicates),
                      .disordered = static_cast<std::int64_t>(count.disordered)});
  }
  return counts;
}

}  // namespace spindrift
