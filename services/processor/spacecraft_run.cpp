#include "services/processor/spacecraft_run.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <limits>
#include <random>
#include <string_view>
#include <utility>

#include "services/clock/wall_clock.h"
#include "services/processor/version.h"

namespace spindrift {
namespace {

// More samples than a run can have.
constexpr std::int64_t kArrivalsOfARun = 1'000'000'000'000;
// So many are worked on before anybody looks whether there is time for more.
constexpr std::size_t kSamplesPerInput = 1024;

/// Unique over all archives that may ever be merged: the seconds of its start and fifty random
/// bits, five a character. Short, since every row of a run bears it.
std::string new_run_id() {
  constexpr std::string_view kDigits = "0123456789abcdefghjkmnpqrstvwxyz";
  std::random_device random;
  std::string id;
  for (int shift = 30; shift >= 0; shift -= 5) {
    id += kDigits[(static_cast<std::uint64_t>(tai_ns(tai_now())) / 1'000'000'000U >> shift) % 32U];
  }
  std::generate_n(std::back_inserter(id), 10, [&] { return kDigits[random() % 32U]; });
  return id;
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
      start_{.spacecraft_kind = std::string{name_of(mission.kind())},
             .mode = source.mode,
             .software_version = kSoftwareVersion,
             .config_toml = mission.toml_text,
             .config_sha256 = mission.sha256,
             .orbit_sha256 = mission.orbit_sha256,
             .telemetry = source.telemetry,
             .started_utc = utc_now(),
             // Sets runs of different archives apart, should they be merged. Order does not rest on
             // the clock: arrive_after.
             .first_arrival = tai_ns(tai_now())},
      run_id_{new_run_id()},
      next_arrival_{start_.first_arrival},
      silent_before_{next_arrival_},
      tables_{mission.tables} {}

void SpacecraftRun::arrive_after(std::int64_t first_arrival) {
  next_arrival_ = std::max(next_arrival_, first_arrival + kArrivalsOfARun);
  silent_before_ = start_.first_arrival = next_arrival_;
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

Received SpacecraftRun::received(const std::string& run_id) const {
  const auto before = received_before_.find(run_id);
  return before == received_before_.end() ? received_ : before->second;
}

SpacecraftRun::Taken SpacecraftRun::nothing_taken() const {
  return {.batches = {batch()}, .inputs = {{.spacecraft = index_, .run_id = run_id_}}};
}

SpacecraftRun::Taken SpacecraftRun::go_on(const std::vector<StoredPass>& stored) {
  Taken out;
  for (const StoredPass& pass : stored) {
    go_on(pass, out);
    out.reached.push_back(watch_.reached());
  }
  stored_.emplace(stored.back());
  return out;
}

void SpacecraftRun::go_on(const StoredPass& stored, Taken& out) {
  if (!out.inputs.empty()) {
    received_before_.emplace(run_id_, received_);
  }
  run_id_ = stored.run_id;
  received_ = {.rejected_inputs = stored.rejected_inputs};
  next_arrival_ = stored.first_arrival;
  earliest_ = stored_earliest_ = stored.earliest;
  counts_before_.clear();
  for (const SourceCount& count : stored.source_counts) {
    counts_before_.emplace(count.source, counts_of(count));
  }
  watch_ = {};
  held_.clear();
  // Not finished, whatever becomes of this service; nothing of it is withdrawn yet.
  out.batches.push_back(batch());
  out.batches.back().continuation = Continuation{.t = TaiTime::max()};
  out.inputs.push_back({.spacecraft = index_, .run_id = run_id_});
  in_order_of_arrival(
      stored.values, stored.silences,
      [&](const auto& arrived) {
        next_arrival_ = std::max(next_arrival_, arrived.arrival + 1);
        received_.count(arrived.value);
        place(arrived, out);
      },
      [&](std::int64_t arrival) { hand_on_silence(arrival, out.inputs); });
}

SpacecraftRun::Taken SpacecraftRun::take(SampleBatch samples) {
  tell_undescribed(samples.samples);
  Taken out = nothing_taken();
  in_order_of_arrival(samples.samples, [&](auto& sample) { sort(std::move(sample), out); });
  tell_both();
  for (const RejectedInput& rejected : samples.rejected) {
    received_.rejected_inputs += rejected.samples;
  }
  ArchiveBatch& last = out.batches.back();
  note_earliest(last);
  last.rejected = std::move(samples.rejected);
  last.source_counts = source_counts(samples.counts);
  return out;
}

SpacecraftRun::Taken SpacecraftRun::fall_silent() {
  if (silent_before_ == next_arrival_) {
    return {};
  }
  Taken out = nothing_taken();
  out.batches.back().silences.push_back(next_arrival_);
  hand_on_silence(next_arrival_, out.inputs);
  return out;
}

void SpacecraftRun::hand_on_silence(std::int64_t arrival, std::vector<PassInput>& inputs) {
  silent_before_ = arrival;
  // Samples that came again have an arrival and are not stored: the next one is behind them.
  next_arrival_ = std::max(next_arrival_, arrival);
  inputs.back().silences.push_back(static_cast<std::int64_t>(sample_count(inputs.back())));
}

void SpacecraftRun::note_earliest(ArchiveBatch& batch) {
  if (earliest_ != stored_earliest_) {
    batch.earliest = stored_earliest_ = earliest_;
  }
}

void SpacecraftRun::tell_both() {
  if (!told_both_ && received_.of<Pulse>() > 0 && received_.of<CodedFrame>() > 0) {
    told_both_ = true;
    spdlog::warn(
        "{}: both pulses and coded frames arrive: an edge that both give is used as the one that "
        "comes first",
        spacecraft_id_);
  }
}

/// Of each kind once.
void SpacecraftRun::tell_undescribed(const TelemetrySamples& samples) {
  TelemetryKinds::for_each([&]<class Value>(Kind<Value> /*kind*/) {
    constexpr std::string_view kSensor = Telemetry<Value>::kSensor;
    bool& told = told_undescribed_[kTelemetryKind<Value>];
    if (!told && !kSensor.empty() && !samples.of<Value>().empty() &&
        !tables_.contains(std::string{kSensor})) {
      told = true;
      spdlog::warn(
          "{}: {} arrive, and the mission file has no [{}]: they are stored, and nothing is "
          "computed from them",
          spacecraft_id_, Telemetry<Value>::kPlural, kSensor);
    }
  });
}

std::vector<PassInput> SpacecraftRun::finish() {
  std::vector<PassInput> rest = nothing_taken().inputs;
  release_held(rest);
  return rest;
}

template <class Value>
void SpacecraftRun::sort(TelemetrySample<Value>&& sample, Taken& out) {
  sample.arrival = next_arrival_++;
  received_.count(sample.value);
  lower(earliest_, sample.value.t);
  if (!is_known(sample.value)) {
    place(Arrived<Value>{.arrival = sample.arrival, .value = sample.value}, out);
  }
  // A new pass that it begins has made a batch of its own.
  out.batches.back().samples.of<Value>().push_back(std::move(sample));
}

/// Sent again: one sample is not to be believed for two.
template <class Value>
bool SpacecraftRun::is_known(const Value& value) const {
  const auto is_it = [key = order_of(value)](const Held& held) {
    return std::visit([&](const auto& arrived) { return order_of(arrived.value) == key; }, held);
  };
  return (stored_ && stored_->hold(value)) || std::any_of(held_.begin(), held_.end(), is_it);
}

template <class Value>
void SpacecraftRun::place(const Arrived<Value>& arrived, Taken& out) {
  const PassWatch::Verdict verdict = watch_.see(arrived.value.t);
  if (verdict == PassWatch::Verdict::Within) {
    hand_on(arrived.value, out.inputs);
  } else if (verdict == PassWatch::Verdict::Onward) {
    stored_.reset();
    release_held(out.inputs);
    hand_on(arrived.value, out.inputs);
  } else {
    held_.emplace_back(arrived);
    if (verdict == PassWatch::Verdict::NewPass) {
      begin_new_pass(out);
    }
  }
}

template <class Value>
void SpacecraftRun::hand_on(const Value& value, std::vector<PassInput>& inputs) const {
  if (sample_count(inputs.back()) >= kSamplesPerInput) {
    inputs.push_back({.spacecraft = index_, .run_id = run_id_});
  }
  const auto place = static_cast<std::int64_t>(sample_count(inputs.back()));
  inputs.back().values.of<Value>().push_back({.arrival = place, .value = value});
}

void SpacecraftRun::release_held(std::vector<PassInput>& inputs) {
  for (const Held& held : std::exchange(held_, {})) {
    std::visit([&](const auto& arrived) { hand_on(arrived.value, inputs); }, held);
  }
}

void SpacecraftRun::begin_new_pass(Taken& out) {
  const std::vector<Held> its_first = std::exchange(held_, {});
  Received its_own;
  for (const Held& held : its_first) {
    std::visit(
        [&](const auto& arrived) {
          its_own.count(arrived.value);
          received_.count(arrived.value, -1);
        },
        held);
  }
  received_before_.emplace(run_id_, received_);
  note_earliest(out.batches.back());

  start_.started_utc = utc_now();
  start_.first_arrival =
      std::visit([](const auto& arrived) { return arrived.arrival; }, its_first.front());
  run_id_ = new_run_id();
  out.batches.push_back(begin());
  out.inputs.push_back({.spacecraft = index_, .run_id = run_id_});
  received_ = its_own;
  earliest_.reset();
  stored_earliest_.reset();
  counts_before_.clear();
  counts_of_earlier_runs_ = latest_counts_;
  stored_.reset();
  watch_ = {};
  for (const Held& held : its_first) {
    std::visit(
        [&](const auto& arrived) {
          lower(earliest_, arrived.value.t);
          place(arrived, out);
        },
        held);
  }
  note_earliest(out.batches.back());
  spdlog::info("{}: more than an hour of silence, a new run begins: {}", spacecraft_id_, run_id_);
}

std::vector<SourceCount> SpacecraftRun::source_counts(
    const std::map<std::string, SequenceCounts>& by_source) {
  const auto find = [](const auto& counts, const std::string& source) {
    const auto found = counts.find(source);
    return found == counts.end() ? SequenceCounts{} : found->second;
  };
  std::vector<SourceCount> counts;
  counts.reserve(by_source.size());
  for (const auto& [source, since_start] : by_source) {
    latest_counts_.insert_or_assign(source, since_start);
    SequenceCounts count = find(counts_before_, source);
    count += since_start;
    const SequenceCounts earlier = find(counts_of_earlier_runs_, source);
    // A gap of an earlier run that was filled since is less than none of this one: sums over runs
    // hold.
    const auto of_run = [](std::uint64_t all, std::uint64_t before) {
      return static_cast<std::int64_t>(all) - static_cast<std::int64_t>(before);
    };
    counts.push_back({.source = source,
                      .received = of_run(count.received, earlier.received),
                      .gaps = of_run(count.missing, earlier.missing),
                      .duplicates = of_run(count.duplicates, earlier.duplicates),
                      .disordered = of_run(count.disordered, earlier.disordered)});
  }
  return counts;
}

}  // namespace spindrift
