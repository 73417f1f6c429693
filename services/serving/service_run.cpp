#include "services/serving/service_run.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <systemd/sd-daemon.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <map>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>

#include "services/archive/submit_all.h"
#include "services/base/contained.h"
#include "services/base/warning.h"
#include "services/ingest/telemetry_subscriber.h"
#include "services/serving/background_solving.h"
#include "services/serving/computing.h"
#include "services/serving/heartbeat.h"
#include "services/serving/routing.h"

namespace spindrift {
namespace {

// Limit of samples that wait to be computed: a whole day's pass in a burst.
constexpr std::size_t kSamplesToCompute = 1'000'000;
constexpr std::chrono::milliseconds kStuckPoll{200};
// Stored samples are computed this long after the signal to stop; the next start does the rest.
constexpr std::chrono::seconds kComputedWhenStopped{8};

Expected<void> finish(Processor& processor, Archive& archive, const Patience& patience) {
  const std::size_t spacecraft = processor.spacecraft().size();
  for (std::size_t i = 0; i < spacecraft; ++i) {
    if (patience.ended) {
      warn("runs_not_finished", {{"spacecraft", spacecraft - i}},
           fmt::format("the runs of {} spacecraft are not finished yet: the next start of the "
                       "service will",
                       spacecraft - i));
      return {};
    }
    if (auto stored = submit_all(archive, processor.finish(i)); !stored) {
      return stored;
    }
  }
  return {};
}

/// Runs the routing, the computing and the solving threads. In the end the runs are finished if all
/// their samples are computed and all their solutions made. A thread that can no longer empty its
/// queue closes it, so that no other thread waits for room.
void route_and_compute(std::vector<PassInput> again, BoundedQueue<PassInput>& backlog,
                       const Patience& patience, Heard& heard, const ServiceParts& parts) {
  Processor& processor = parts.processor;
  Archive& archive = parts.archive;
  ThreadFailures& failures = parts.failures;
  BackgroundTasks tasks;
  Computing computing{processor, archive, backlog, tasks, patience};
  std::atomic<std::size_t> solutions_left = 0;
  const auto solve = [&](BoundedQueue<BackgroundTask>& of) {
    failures.report(contained(
        "solving", [&] { solutions_left += solve_in_background(of, archive, patience); }));
    of.close();
  };
  std::thread solving{[&] { solve(tasks.usual); }};
  std::thread solving_awaited{[&] { solve(tasks.awaited); }};
  std::thread working_off{[&] {
    failures.report(contained("computing the backlog", [&] { return computing.work_off(); }));
    backlog.close();
  }};
  failures.report(contained("taking in", [&] {
    return route(std::move(again), parts.taken, processor, parts.told.clocks, archive, computing,
                 heard, parts.problems);
  }));
  parts.taken.close();
  backlog.close();
  working_off.join();
  tasks.usual.close();
  tasks.awaited.close();
  solving.join();
  solving_awaited.join();
  if (!failures.first() || solutions_left > 0) {
    return;
  }
  if (computing.samples_left() > 0) {
    warn("samples_not_computed", {{"samples", computing.samples_left()}},
         fmt::format("{} samples are stored and not computed yet: the next start of the service "
                     "will",
                     computing.samples_left()));
    return;
  }
  failures.report(contained("finishing", [&] {
    return finish(processor, archive, patience).and_then(parts.on_finished);
  }));
}

/// Ends waiting for the computation some time after the service is told to stop. While writing
/// fails it does not wait at all: the archive is closed and makes its last attempt at once.
void lose_patience(const std::stop_token& done, Patience& patience,
                   BoundedQueue<SampleBatch>& queue, Archive& archive) {
  std::optional<std::chrono::steady_clock::time_point> until;
  while (!done.stop_requested()) {
    if (patience.stopping && archive.statistics().failure) {
      queue.close();
      static_cast<void>(archive.close());  // The error is returned again by the next close().
      return;
    }
    const auto now = std::chrono::steady_clock::now();
    if (patience.stopping && !until) {
      until = now + kComputedWhenStopped;
    }
    patience.ended = until && now >= *until;
    std::this_thread::sleep_for(kStuckPoll);
  }
}

Expected<void> how_taking_ended(const TelemetrySubscriber& subscriber) {
  const auto status = subscriber.status();
  if (!status) {
    return Unexpected{status.error()};
  }
  if (status->discarded > 0) {
    spdlog::error(
        "{} samples that their senders take for delivered were discarded by the stop: "
        "send them again",
        status->discarded);
  }
  if (!status->failure.empty()) {
    return Unexpected{{ErrorCode::Unavailable, status->failure}};
  }
  return {};
}

/// Tells the watches what was stored before a restart.
void note_stored(const GoneOn& gone_on, const Processor& processor, Heard& heard, AlertDesk& desk) {
  const auto spacecraft = processor.spacecraft();
  const auto now = std::chrono::steady_clock::now();
  std::map<std::string, TaiTime> newest;
  for (const PassInput& input : gone_on.routed.work) {
    const std::string& id = spacecraft.at(input.spacecraft);
    input.values.for_each([&](const auto& of_kind) {
      for (const auto& arrived : of_kind) {
        TaiTime& last = newest.try_emplace(id, arrived.value.t).first->second;
        last = std::max(last, arrived.value.t);
      }
    });
    desk.go_on(id, input.run_id, input.values);
  }
  if (!newest.empty()) {
    heard.silences = SilenceWatch{now + kHeldBack};
  }
  for (const auto& [id, t] : newest) {
    heard.sessions.go_on(id, gone_on.last_origins, t);
    heard.links.go_on(id, t, now);
  }
  for (const auto& [id, last] : gone_on.last_runs) {
    if (last.last_sample) {
      heard.links.go_on(id, *last.last_sample, now);
    }
  }
}

}  // namespace

Expected<void> run_service(GoneOn gone_on, const ServiceParts& parts) {
  BoundedQueue<PassInput> work{kSamplesToCompute,
                               [](const PassInput& input) { return sample_count(input); }};
  const auto spacecraft = parts.processor.spacecraft();
  auto started = TelemetrySubscriber::start(
      parts.participant, parts.taken, {spacecraft.begin(), spacecraft.end()}, gone_on.last_origins);
  if (!started) {
    return Unexpected{started.error()};
  }
  TelemetrySubscriber& subscriber = **started;
  Heard heard{.links = LinkWatch{spacecraft}, .sessions = {}, .silences = SilenceWatch{}};
  note_stored(gone_on, parts.processor, heard, parts.desk);
  Patience patience;
  parts.stop_signal.on_stop([&] {
    static_cast<void>(sd_notify(0, "STOPPING=1"));
    spdlog::info("stopping");
    patience.stopping = true;
    parts.failures.report(contained("stopping", [&] { subscriber.stop(); }));
    parts.taken.close();
  });
  const std::jthread watching{[&](const std::stop_token& done) {
    parts.failures.report(contained(
        "watching the stop", [&] { lose_patience(done, patience, parts.taken, parts.archive); }));
  }};
  {
    const Heartbeat heartbeat{parts, heard, subscriber, work};
    // Without systemd there is nobody to notify, which is no error.
    static_cast<void>(sd_notify(0, "READY=1"));
    spdlog::info("ready");
    route_and_compute(std::move(gone_on.routed.work), work, patience, heard, parts);
  }
  parts.stop_signal.join();
  auto taking = how_taking_ended(subscriber);
  return parts.failures.first().and_then([&] { return std::move(taking); });
}

}  // namespace spindrift
