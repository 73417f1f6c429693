#include "services/processor/spacecraft_run.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <iterator>
#include <limits>
#include <numeric>
#include <utility>

#include "pipelines/time/time_span.h"
#include "pipelines/time/utc.h"
#include "services/base/unique_id.h"
#include "services/base/wall_clock.h"
#include "services/processor/told.h"
#include "services/processor/version.h"
#include "services/products/notice_of.h"

namespace spindrift {
namespace {

// No run has as many samples as this.
constexpr std::int64_t kArrivalsOfARun = 1'000'000'000'000;
// After this many samples the computing side looks again whether there is time for more.
constexpr std::size_t kSamplesPerInput = 1024;

SequenceCounts counts_of(const SourceCount& count) {
  return {.received = static_cast<std::uint64_t>(count.received),
          .missing = static_cast<std::uint64_t>(count.gaps),
          .duplicates = static_cast<std::uint64_t>(count.duplicates),
          .disordered = static_cast<std::uint64_t>(count.disordered)};
}

std::size_t total(const Received& received) {
  return static_cast<std::size_t>(
      std::accumulate(received.samples.begin(), received.samples.end(), std::int64_t{0}));
}

SourceWatch source_watch(RunMode mode, double host_within_s) {
  const auto within = later_by_s(TaiTime{}, host_within_s) - TaiTime{};
  const SourceLimits by_clock{.within = within, .silence = within};
  return mode == RunMode::Live ? SourceWatch{by_clock, by_clock} : SourceWatch{by_clock};
}

}  // namespace

SpacecraftRun::SpacecraftRun(const Mission& mission, const TelemetrySource& source,
                             std::size_t index)
    : spacecraft_id_{mission.spacecraft_id},
      index_{index},
      start_{.spacecraft_kind = mission.kind(),
             .mode = source.mode,
             .software_version = kSoftwareVersion,
             .config_toml = mission.toml_text,
             .config_sha256 = mission.sha256,
             .config_path = mission.path.string(),
             .orbit_sha256 = mission.orbit_sha256,
             .telemetry_sha256 = source.sha256,
             .label = source.label,
             .telemetry = source.telemetry,
             .started_utc = {},
             // The clock keeps arrivals of different archives apart in case they are merged. Order
             // within an archive does not rest on it: see arrive_after.
             .first_arrival = {tai_ns(tai_now())}},
      orbit_doubts_{mission.orbit_doubts},
      run_id_{unique_id()},
      next_arrival_{start_.first_arrival},
      silent_before_{next_arrival_},
      contact_{mission.contact},
      reach_{contact_},
      senders_{mission.preferred_source},
      notices_{mission},
      judges_sources_{source.mode != RunMode::Process},
      new_sources_{source_watch(source.mode, mission.host_within_s)},
      sources_{new_sources_} {}

void SpacecraftRun::arrive_after(RunPlace first_arrival) {
  next_arrival_ = std::max(next_arrival_, {first_arrival.number + kArrivalsOfARun});
  silent_before_ = start_.first_arrival = next_arrival_;
}

ArchiveBatch SpacecraftRun::batch() const {
  ArchiveBatch batch;
  batch.run_id = run_id_;
  batch.spacecraft_id = spacecraft_id_;
  batch.preferred_source = senders_.preferred();
  return batch;
}

SpacecraftRun::Taken SpacecraftRun::begin() {
  start_.started_utc = utc_now();
  Taken first = nothing_taken();
  first.batches.front().start = start_;
  if (begins_with_) {
    first.batches.front().products.emplace_back(*std::exchange(begins_with_, std::nullopt));
  }
  // No warning is issued here: the code that loads the mission warns before a run exists.
  for (const std::string& doubt : orbit_doubts_) {
    first.batches.front().products.emplace_back(notice_of(
        "orbit_doubt",
        {{"spacecraft", spacecraft_id_}, {"file", start_.config_path}, {"why", doubt}}, doubt));
  }
  repeat_actions_before(start_.first_arrival, first);
  return first;
}

/// Begins the run with the source counts that came before it.
SpacecraftRun::Taken SpacecraftRun::begin_with(SampleBatch& samples) {
  samples.counts.insert(latest_counts_.begin(), latest_counts_.end());
  return begin();
}

Received SpacecraftRun::received(const std::string& run_id) const {
  const auto before = received_before_.find(run_id);
  return before == received_before_.end() ? received_ : before->second;
}

SpacecraftRun::Taken SpacecraftRun::nothing_taken() const {
  return {.batches = {batch()}, .inputs = {{.spacecraft = index_, .run_id = run_id_}}};
}

SpacecraftRun::Taken SpacecraftRun::go_on(const std::vector<StoredPass>& stored,
                                          const Moment& moment) {
  Taken out;
  for (const StoredPass& pass : stored) {
    go_on(pass, out);
    out.reached.push_back(watch_.reached());
  }
  stored_.emplace(stored.back());
  restore_sources(stored.back(), moment);
  return out;
}

void SpacecraftRun::restore_sources(const StoredPass& stored, const Moment& moment) {
  RunPlace last_in_time;
  stored.values.for_each([&](const auto& of_kind) {
    last_in_time = std::max(last_in_time, of_kind.empty() ? RunPlace{} : of_kind.back().arrival);
  });
  for (const std::vector<Origin>& of_kind : stored.last_origins) {
    for (const Origin& origin : of_kind) {
      sources_.restore_in_time(origin, moment);
    }
  }
  if (stored.clock) {
    sources_.restore_leader(*stored.clock, moment);
    leader_ = sources_.leader();
  }
  for (const LeftOut& left_out : stored.left_out) {
    in_order_of_arrival(left_out.values, [&](const auto& arrived) {
      next_arrival_ = std::max(next_arrival_, place_after(arrived.arrival));
      sources_.restore_apart(left_out.last, arrived, arrived.arrival > last_in_time, moment);
    });
  }
}

void SpacecraftRun::go_on(const StoredPass& stored, Taken& out) {
  if (!out.inputs.empty()) {
    received_before_.emplace(run_id_, received_);
    release_held(out.inputs);
    end_reach(out.batches.back());
  }
  run_id_ = stored.run_id;
  received_ = {.rejected_inputs = stored.rejected_inputs};
  next_arrival_ = stored.first_arrival;
  reach_ = ReachWatch{contact_};
  counts_before_.clear();
  for (const SourceCount& count : stored.source_counts) {
    counts_before_.emplace(count.source, counts_of(count));
  }
  watch_ = {};
  sources_ = new_sources_;
  // Marks the run as unfinished, whatever happens to this service, and withdraws nothing.
  out.batches.push_back(batch());
  out.batches.back().continuation = Continuation{.t = TaiTime::max()};
  out.inputs.push_back({.spacecraft = index_, .run_id = run_id_});
  repeat_actions_before(stored.first_arrival, out);
  std::vector<OperatorAction> of_this_run;
  std::copy_if(actions_.begin(), actions_.end(), std::back_inserter(of_this_run),
               [&](const OperatorAction& action) {
                 return action.arrival >= stored.first_arrival &&
                        (!stored.next_arrival || action.arrival < *stored.next_arrival);
               });
  std::vector<OperatorAction>& told = out.batches.back().actions;
  told.insert(told.end(), of_this_run.begin(), of_this_run.end());
  in_order_of_arrival(
      stored.values, stored.silences, of_this_run,
      [&]<class Element>(const Element& arrived) {
        next_arrival_ = std::max(next_arrival_, place_after(arrived.arrival));
        if constexpr (std::is_same_v<Element, OperatorAction>) {
          hand_on(arrived, out.inputs);
        } else {
          received_.count(arrived.value);
          reach_.include(arrived.value.t);
          sources_.restore(arrived.value.t);
          place(arrived, out);
        }
      },
      [&](RunPlace arrival) { hand_on_silence(arrival, out.inputs); });
}

SpacecraftRun::Taken SpacecraftRun::receive(SampleBatch samples, const Moment& moment) {
  if (!has_begun() && size_of(samples) == 0) {
    // Counts without samples belong to samples of another service; the run takes them later.
    static_cast<void>(source_counts(samples.counts));
    return nothing_taken();
  }
  Taken out = has_begun() ? nothing_taken() : begin_with(samples);
  notices_.tell_undescribed(samples.samples, out.batches.back().products);
  in_order_of_arrival(samples.samples, [&](auto& sample) { sort(std::move(sample), moment, out); });
  for (OperatorAction& action : samples.actions) {
    accept(std::move(action), out);
  }
  decide(moment, out);
  if (received_.of<Pulse>() > 0 && received_.of<CodedFrame>() > 0) {
    notices_.tell_both(out.batches.back().products);
  }
  for (const RejectedInput& rejected : samples.rejected) {
    received_.rejected_inputs += rejected.samples;
  }
  ArchiveBatch& last = out.batches.back();
  note_reach(last);
  last.rejected = std::move(samples.rejected);
  last.source_counts = source_counts(samples.counts);
  return out;
}

SpacecraftRun::Taken SpacecraftRun::decide(const Moment& moment) {
  Taken out = nothing_taken();
  decide(moment, out);
  note_reach(out.batches.back());
  return out;
}

void SpacecraftRun::decide(const Moment& moment, Taken& out) {
  if (const auto successor = sources_.successor(moment)) {
    follow(*successor, moment, out);
  }
  notices_.tell_sources(sources_, out.batches.back().products);
}

/// Stores whose telemetry is the clock from the next sample on, where that has changed, and reports
/// it live.
void SpacecraftRun::note_clock(Taken& out) {
  if (leader_ == sources_.leader()) {
    return;
  }
  leader_ = sources_.leader();
  SourceClock clock{.arrival = next_arrival_, .source = std::nullopt};
  if (leader_) {
    clock.source = Origin{.source = leader_->name, .session = leader_->session, .seq = 0};
    if (start_.mode == RunMode::Live) {
      out.batches.back().products.emplace_back(
          notices_.clock_told(leader_->name, sources_.recent(*leader_)));
    }
  }
  out.batches.back().clocks.push_back(std::move(clock));
}

void SpacecraftRun::follow(const SourceId& successor, const Moment& moment, Taken& out) {
  const TaiTime before = sources_.pass_time().value_or(sources_.recent(successor));
  const TaiTime t = sources_.recent(successor);
  const auto leader = sources_.leader();
  const TelemetryValues held = sources_.follow(successor, moment);
  if (count_of(held) == 0) {
    note_clock(out);
    return;
  }
  stored_.reset();
  const auto span = span_between(before, t);
  if (span <= PassWatch::kLongestSilence && !are_apart(before, std::min(before, t))) {
    note_clock(out);
    accept(held, out);
    return;
  }
  notices_.tell_new_run(successor, t, leader, before);
  release_held(out.inputs);
  begin_new_pass(held, out);
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

void SpacecraftRun::hand_on_silence(RunPlace arrival, std::vector<PassInput>& inputs) {
  silent_before_ = arrival;
  // Repeated samples have an arrival but are not stored, so the next one is behind them.
  next_arrival_ = std::max(next_arrival_, arrival);
  inputs.back().silences.push_back(next_place(inputs.back()));
}

void SpacecraftRun::hand_on(OperatorAction action, std::vector<PassInput>& inputs) {
  inputs.back().actions.push_back({.place = next_place(inputs.back()), .value = std::move(action)});
}

/// An action without a time applies from the time that the telemetry has reached, and before any
/// from now on; in a replay, whose telemetry may be of any time, from its beginning.
void SpacecraftRun::accept(OperatorAction&& action, Taken& out) {
  const TaiTime before_any = start_.mode == RunMode::Live ? tai_now() : TaiTime{};
  action.t = action.t ? *action.t : watch_.reached().value_or(before_any);
  action.arrival = new_arrival();
  spdlog::info("{}: {} from {} on, by {}: {} {} {}", spacecraft_id_, action.action,
               format_utc(*action.t), action.by, action.arguments, action.note, action.action_id);
  hand_on(action, out.inputs);
  out.batches.back().actions.push_back(action);
  actions_.push_back(std::move(action));
}

/// Hands earlier actions to the run that begins in `out`; they apply to its telemetry too.
void SpacecraftRun::repeat_actions_before(RunPlace first_arrival, Taken& out) {
  for (const OperatorAction& action : actions_) {
    if (action.arrival < first_arrival) {
      hand_on(action, out.inputs);
      out.batches.back().actions.push_back(action);
    }
  }
}

SpacecraftRun::Taken SpacecraftRun::finish() {
  Taken rest = nothing_taken();
  while (const auto source = sources_.caught_up_with()) {
    accept(sources_.take_held(*source), rest);
  }
  if (const auto successor = sources_.successor_at_end(total(received_))) {
    follow(*successor, {}, rest);
  }
  if (sources_.held() > 0) {
    rest.batches.back().products.emplace_back(told(
        "samples_of_source_apart", {{"spacecraft", spacecraft_id_}, {"samples", sources_.held()}},
        fmt::format("{}: {} samples are stored and left out, since their source's time disagrees",
                    spacecraft_id_, sources_.held())));
  }
  if (watch_.ends_in_new_pass()) {
    begin_new_pass_of_held(rest);
  }
  release_held(rest.inputs);
  end_reach(rest.batches.back());
  return rest;
}

/// Puts changes of the reach into `batch`, and leaves it alone when there are none: a run that
/// began in this batch may already have put its reach there.
void SpacecraftRun::note_reach(ArchiveBatch& batch) {
  if (const auto news = reach_.take_news()) {
    batch.reach = news;
  }
}

/// Only a run of files reports silences at its end: live, an alert reports them as they happen.
void SpacecraftRun::end_reach(ArchiveBatch& batch) {
  batch.reach = reach_.take_last();
  if (start_.mode == RunMode::Process) {
    notices_.tell_silences(reach_.silences(), batch.products);
  }
}

template <class Value>
void SpacecraftRun::sort(TelemetrySample<Value>&& sample, const Moment& moment, Taken& out) {
  senders_.put_into(sample);
  const SourceWatch::Verdict verdict = judge(sample, moment);
  note_clock(out);
  switch (verdict) {
    case SourceWatch::Verdict::Apart: {
      ArrivedSample<Value> apart = arrived(std::move(sample));
      apart.is_left_out = true;
      out.batches.back().samples.of<Value>().push_back(std::move(apart));
      return;
    }
    case SourceWatch::Verdict::Healed:
      accept(sources_.take_held({sample.origin.source, sample.origin.session}), out);
      break;
    case SourceWatch::Verdict::InTime:
      break;
  }
  accept(std::move(sample), out);
}

template <class Value>
ArrivedSample<Value> SpacecraftRun::arrived(TelemetrySample<Value>&& sample) {
  return {.spacecraft = std::move(sample.spacecraft),
          .origin = std::move(sample.origin),
          .value = std::move(sample.value),
          .arrival = new_arrival()};
}

template <class Value>
SourceWatch::Verdict SpacecraftRun::judge(const TelemetrySample<Value>& sample,
                                          const Moment& moment) {
  if (!judges_sources_) {
    return SourceWatch::Verdict::InTime;
  }
  if (stored_ && stored_->hold(sample.value)) {
    sources_.hear(sample.origin, moment);
    return SourceWatch::Verdict::InTime;
  }
  return sources_.admit(sample.origin,
                        Arrived<Value>{.arrival = next_arrival_, .value = sample.value}, moment);
}

/// Accepts held samples in the order in which they came, with new arrivals.
void SpacecraftRun::accept(const TelemetryValues& held, Taken& out) {
  in_order_of_arrival(held, [&]<class Value>(const Arrived<Value>& left_out) {
    const Arrived<Value> arrived{.arrival = new_arrival(), .value = left_out.value};
    received_.count(arrived.value);
    reach_.include(arrived.value.t);
    out.batches.back().moved.of<Value>().push_back(arrived);
    place(arrived, out);
  });
}

template <class Value>
void SpacecraftRun::accept(TelemetrySample<Value>&& sample, Taken& out) {
  ArrivedSample<Value> taken = arrived(std::move(sample));
  received_.count(taken.value);
  reach_.include(taken.value.t);
  if (!is_known(taken.value)) {
    place(Arrived<Value>{.arrival = taken.arrival, .value = taken.value}, out);
  }
  // A new pass that the sample begins has appended a batch of its own.
  out.batches.back().samples.of<Value>().push_back(std::move(taken));
}

/// Returns whether the sample was sent before: a repeated sample must not count as two.
template <class Value>
bool SpacecraftRun::is_known(const Value& value) {
  if (stored_ && stored_->hold(value)) {
    return true;
  }
  auto& held = held_.of<Value>();
  const auto same = std::find_if(held.begin(), held.end(), [&value](const Arrived<Value>& arrived) {
    return is_the_same_sample(arrived.value, value);
  });
  if constexpr (HasSender<Value>) {
    // As in the archive, the preferred source replaces another source of the same sample.
    if (same != held.end() && value.sender == Sender::Preferred) {
      same->value.sender = value.sender;
    }
  }
  return same != held.end();
}

template <class Value>
void SpacecraftRun::place(const Arrived<Value>& arrived, Taken& out) {
  const PassWatch::Verdict verdict = watch_.judge(arrived.value.t, kTelemetryKind<Value>);
  if (verdict == PassWatch::Verdict::Within) {
    hand_on(arrived.value, out.inputs);
  } else if (verdict == PassWatch::Verdict::Onward) {
    reach_.carry_on(arrived.value.t);
    stored_.reset();
    release_held(out.inputs);
    hand_on(arrived.value, out.inputs);
  } else {
    held_.of<Value>().push_back(arrived);
    if (verdict == PassWatch::Verdict::NewPass) {
      begin_new_pass_of_held(out);
    }
  }
}

template <class Value>
void SpacecraftRun::hand_on(const Value& value, std::vector<PassInput>& inputs) const {
  if (sample_count(inputs.back()) >= kSamplesPerInput) {
    inputs.push_back({.spacecraft = index_, .run_id = run_id_});
  }
  const BatchPlace place = next_place(inputs.back());
  if (inputs.back().senders != senders_.names()) {
    inputs.back().senders = senders_.names();
  }
  inputs.back().values.of<Value>().push_back({.place = place, .value = value});
}

void SpacecraftRun::begin_new_pass_of_held(Taken& out) {
  const TelemetryValues its_first = std::exchange(held_, {});
  in_order_of_arrival(its_first, [&](const auto& first) { received_.count(first.value, -1); });
  spdlog::info("{}: more than an hour of silence, a new run begins", spacecraft_id_);
  begin_new_pass(its_first, out);
}

void SpacecraftRun::release_held(std::vector<PassInput>& inputs) {
  in_order_of_arrival(std::exchange(held_, {}),
                      [&](const auto& held) { hand_on(held.value, inputs); });
}

void SpacecraftRun::begin_new_pass(const TelemetryValues& its_first, Taken& out) {
  received_before_.emplace(run_id_, received_);
  end_reach(out.batches.back());

  start_.first_arrival = next_arrival_;
  run_id_ = unique_id();
  Taken first = begin();
  std::move(first.batches.begin(), first.batches.end(), std::back_inserter(out.batches));
  std::move(first.inputs.begin(), first.inputs.end(), std::back_inserter(out.inputs));
  received_ = {};
  reach_ = ReachWatch{contact_};
  counts_before_.clear();
  counts_of_earlier_runs_ = latest_counts_;
  stored_.reset();
  watch_ = {};
  leader_.reset();  // Each run says by itself what its clock is.
  note_clock(out);
  accept(its_first, out);
  note_reach(out.batches.back());
  spdlog::info("{}: run {}", spacecraft_id_, run_id_);
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
    // When a gap of an earlier run is filled now, this count is negative: sums over runs hold.
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
