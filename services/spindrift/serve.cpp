#include "services/spindrift/serve.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <atomic>
#include <chrono>
#include <stop_token>
#include <thread>
#include <utility>

#include "services/archive/archive.h"
#include "services/bus/participant.h"
#include "services/ingest/telemetry_subscriber.h"
#include "services/mission/mission.h"
#include "services/processor/processor.h"
#include "services/publisher/result_publisher.h"
#include "services/spindrift/announcer.h"
#include "services/spindrift/heartbeat.h"
#include "services/spindrift/outcome.h"
#include "services/spindrift/stop_signal.h"
#include "services/spindrift/submit_all.h"
#include "services/spindrift/summary_text.h"

namespace spindrift {
namespace {

// Batches of up to 256 samples between the thread that takes and the one that routes.
constexpr std::size_t kTakenBatches = 256;
// Samples between the thread that routes and the one that computes: a whole day's pass in a burst.
constexpr std::size_t kSamplesToCompute = 1'000'000;
constexpr std::chrono::milliseconds kStuckPoll{200};

Expected<std::vector<Mission>> load_missions(const std::vector<std::filesystem::path>& paths) {
  std::vector<Mission> missions;
  std::string problems;
  for (const std::filesystem::path& path : paths) {
    auto mission = load_mission(path);
    if (mission) {
      missions.push_back(std::move(*mission));
    } else {
      problems += (problems.empty() ? "" : "\n") + mission.error().message;
    }
  }
  if (!problems.empty()) {
    return Unexpected{{ErrorCode::InvalidConfiguration, problems}};
  }
  return missions;
}

std::size_t sample_count(const PassInput& work) { return work.pulses.size() + work.frames.size(); }

/// Hands what is taken to the archive, then to `work`, until `taken` is closed and empty, the
/// archive refuses or `work` is closed.
Expected<void> route(BoundedQueue<SampleBatch>& taken, Processor& processor, Archive& archive,
                     BoundedQueue<PassInput>& work) {
  for (auto batches = taken.take_all(); !batches.empty(); batches = taken.take_all()) {
    for (SampleBatch& batch : batches) {
      Routed routed = processor.route(std::move(batch));
      auto going = submit_all(archive, std::move(routed.samples));
      bool wanted = going.has_value();
      for (PassInput& input : routed.work) {
        wanted = wanted && work.push(std::move(input));
      }
      if (!wanted) {
        taken.close();  // Nobody empties it any more: the taking thread must not wait for room.
        return going;
      }
    }
  }
  return {};
}

/// Works until `work` is closed and empty, or the archive refuses.
Expected<void> compute(BoundedQueue<PassInput>& work, Processor& processor, Archive& archive) {
  for (auto inputs = work.take_all(); !inputs.empty(); inputs = work.take_all()) {
    for (const PassInput& input : inputs) {
      if (auto stored = submit_all(archive, processor.compute(input)); !stored) {
        work.close();  // Nobody empties it any more.
        return stored;
      }
    }
  }
  return {};
}

/// Both at once: samples reach the archive however long the mathematics takes.
Expected<void> route_and_compute(BoundedQueue<SampleBatch>& taken, BoundedQueue<PassInput>& work,
                                 Processor& processor, Archive& archive) {
  Expected<void> computed;
  std::thread computing{[&] { computed = compute(work, processor, archive); }};
  const auto routed = route(taken, processor, archive, work);
  work.close();
  computing.join();
  return routed ? computed : routed;
}

/// While writing fails, submitting waits. A service that is told to stop does not wait for ever: it
/// makes the last attempt now.
void give_up_when_stuck(const std::stop_token& done, const std::atomic<bool>& stopping,
                        BoundedQueue<SampleBatch>& queue, Archive& archive) {
  while (!done.stop_requested()) {
    if (stopping && archive.statistics().failure) {
      queue.close();
      static_cast<void>(
          archive.close());  // What it could not store is said when it is closed again.
      return;
    }
    std::this_thread::sleep_for(kStuckPoll);
  }
}

/// From "ready" until a signal, or a failure, and everything taken is with the archive.
Expected<void> run(const bus::Participant& participant, const ResultPublisher& publisher,
                   Processor& processor, Archive& archive, StopSignal& stop_signal) {
  BoundedQueue<SampleBatch> queue{kTakenBatches};
  BoundedQueue<PassInput> work{kSamplesToCompute, sample_count};
  auto started = TelemetrySubscriber::start(participant, queue);
  if (!started) {
    return Unexpected{started.error()};
  }
  TelemetrySubscriber& subscriber = **started;
  std::atomic<bool> stopping = false;
  stop_signal.on_stop([&] {
    spdlog::info("stopping");
    stopping = true;
    subscriber.stop();
    queue.close();
  });
  const std::jthread give_up{
      [&](const std::stop_token& done) { give_up_when_stuck(done, stopping, queue, archive); }};
  Expected<void> worked;
  {
    const Heartbeat heartbeat{{.subscriber = subscriber,
                               .taken = queue,
                               .work = work,
                               .archive = archive,
                               .publisher = publisher},
                              &StopSignal::raise};
    spdlog::info("ready");
    worked = route_and_compute(queue, work, processor, archive);
  }
  if (!worked) {
    StopSignal::raise();
  }
  stop_signal.join();

  const auto status = subscriber.status();
  if (worked && !status) {
    worked = Unexpected{status.error()};
  } else if (worked && !status->failure.empty()) {
    worked = Unexpected{{ErrorCode::Unavailable, status->failure}};
  }
  const auto finished = submit_all(archive, processor.finish());
  return worked ? finished : worked;
}

}  // namespace

Expected<void> serve(const ServeOptions& options) {
  auto missions = load_missions(options.missions);
  if (!missions) {
    return Unexpected{missions.error()};
  }
  auto processor = Processor::make(
      *missions,
      {.mode = options.partition == "replay" ? "replay" : "live",
       .telemetry = fmt::format("DDS domain {}, partition {}", options.domain, options.partition)});
  if (!processor) {
    return Unexpected{processor.error()};
  }
  StopSignal stop_signal;

  const auto participant =
      bus::Participant::create({.domain = options.domain, .partition = options.partition});
  if (!participant) {
    return Unexpected{participant.error()};
  }
  spdlog::info("{}", participant->description());
  const auto publisher = ResultPublisher::create(*participant);
  if (!publisher) {
    return Unexpected{publisher.error()};
  }
  Announcer announcer{*publisher};
  auto archive = Archive::open(
      options.db,
      {.on_write_failure = OnWriteFailure::Retry,
       .on_committed = [&](std::span<const ArchiveBatch> stored) { announcer.committed(stored); },
       .on_failure =
           [](const Error& error) {
             spdlog::critical("the archive does not store, nothing more is accepted: {}",
                              error.message);
           }});
  if (!archive) {
    return Unexpected{archive.error()};
  }
  spdlog::info("archive {}", options.db.string());

  auto done = processor->go_on(
      options.db, [&](ArchiveBatch batch) { return (*archive)->submit(std::move(batch)); });
  if (done) {
    done = run(*participant, *publisher, *processor, **archive, stop_signal);
  }
  if (auto outcome = outcome_of(done, (*archive)->close()); !outcome) {
    return outcome;
  }
  return report(*processor, options.db, options.json).map([](const std::string& text) {
    fmt::print("{}", text);
  });
}

}  // namespace spindrift
