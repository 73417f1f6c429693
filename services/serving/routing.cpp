#include "services/serving/routing.h"

#include <algorithm>
#include <chrono>
#include <optional>
#include <utility>

#include "services/archive/submit_all.h"
#include "services/base/wall_clock.h"

namespace spindrift {
namespace {

/// Notes arrivals before the samples are submitted, where the archive may make them wait.
void note_arrivals(const std::vector<ArchiveBatch>& samples, Heard& heard) {
  const auto now = std::chrono::steady_clock::now();
  for (const ArchiveBatch& batch : samples) {
    heard.sessions.follow(batch);
    const auto note = [&](const auto& of_kind) {
      const auto last = std::find_if(of_kind.rbegin(), of_kind.rend(),
                                     [](const auto& sample) { return !is_left_out(sample); });
      if (last != of_kind.rend()) {
        heard.links.hear(batch.spacecraft_id, last->value.t, now);
        heard.silences.hear(batch.spacecraft_id, now);
      }
    };
    batch.samples.for_each(note);
    batch.moved.for_each(note);
  }
}

/// Routes the next batch. When none comes, routes the silence of streams instead: a stream is only
/// silent when no batch waits in `taken`.
Routed next_routed(BoundedQueue<SampleBatch>& taken, Processor& processor,
                   const RehearsalClocks& clocks, Heard& heard) {
  const auto next_silence = heard.silences.next();
  const auto next_decision = processor.next_decision();
  const auto next = next_silence && next_decision ? std::min(next_silence, next_decision)
                                                  : std::max(next_silence, next_decision);
  auto batch = next ? taken.take_until(*next) : taken.take();
  const Moment moment = moment_of(processor, clocks);
  const auto came = batch ? batch->came : std::nullopt;
  Routed routed = batch ? processor.route(std::move(*batch), moment)
                        : processor.fall_silent(heard.silences.take_silent(moment.now), moment);
  note_arrivals(routed.samples, heard);
  for (PassInput& input : routed.work) {
    input.came = came;
  }
  return routed;
}

}  // namespace

Moment moment_of(const Processor& processor, const RehearsalClocks& clocks) {
  const TaiTime host = tai_now();
  Moment moment{.now = std::chrono::steady_clock::now(),
                .host = processor.is_live() ? std::optional{host} : std::nullopt};
  for (const auto& [spacecraft, offset] : clocks.offsets()) {
    moment.rehearsed.emplace(spacecraft, later_by(host, -offset));
  }
  return moment;
}

Expected<void> route(std::vector<PassInput> again, BoundedQueue<SampleBatch>& taken,
                     Processor& processor, const RehearsalClocks& clocks, Archive& archive,
                     Computing& computing, Heard& heard, Problems& problems) {
  for (PassInput& input : again) {
    computing.leave_to_backlog(std::move(input));
  }
  while (!taken.is_drained()) {
    Routed routed = next_routed(taken, processor, clocks, heard);
    problems.set_sources(processor.source_problems());
    auto stored = submit_all(archive, std::move(routed.samples));
    for (auto input = routed.work.begin(); stored && input != routed.work.end(); ++input) {
      stored = computing.enqueue(std::move(*input), taken.size());
    }
    if (!stored) {
      return stored;
    }
  }
  return {};
}

}  // namespace spindrift
