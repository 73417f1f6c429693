#include "services/spindrift/serve.h"

#include <fmt/format.h>
#include <pthread.h>
#include <sched.h>
#include <spdlog/spdlog.h>

#include <atomic>
#include <chrono>
#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

#include "services/archive/archive.h"
#include "services/bus/participant.h"
#include "services/ingest/telemetry_subscriber.h"
#include "services/mission/mission.h"
#include "services/processor/processor.h"
#include "services/publisher/result_publisher.h"
#include "services/spindrift/announcer.h"
#include "services/spindrift/comparison_notice.h"
#include "services/spindrift/heartbeat.h"
#include "services/spindrift/orbit_notice.h"
#include "services/spindrift/outcome.h"
#include "services/spindrift/stop_signal.h"
#include "services/spindrift/submit_all.h"
#include "services/spindrift/summary_text.h"

namespace spindrift {
namespace {

// Samples between the thread that takes and the one that routes.
constexpr std::size_t kSamplesTaken = 65'536;
// Samples between the thread that routes and the one that computes: a whole day's pass in a burst.
constexpr std::size_t kSamplesToCompute = 1'000'000;
// Batch solutions that wait: those of a minute of many spacecraft, or of hours in a replay.
constexpr std::size_t kBatchTasks = 256;
constexpr std::chrono::milliseconds kStuckPoll{200};
// A backlog of what was stored is computed for so long after the signal to stop. What is left then
// is computed at the next start.
constexpr std::chrono::seconds kComputedWhenStopped{10};

Expected<std::vector<Mission>> load_missions(const std::vector<std::filesystem::path>& paths) {
  std::vector<Mission> missions;
  std::string problems;
  for (const std::filesystem::path& path : paths) {
    auto mission = load_mission(path);
    if (mission) {
      warn_of_orbit(path, *mission);
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
std::size_t sample_count(const SampleBatch& taken) {
  return taken.pulses.size() + taken.coded.size() + taken.rejected.size();
}

/// Of a service that is told to stop.
struct Patience {
  std::atomic<bool> stopping = false;
  std::atomic<bool> ended = false;  ///< What is stored is no longer computed.
};

/// First `again`. Then hands what is taken to the archive and on to `work`, until `taken` is closed
/// and empty, or the archive refuses.
Expected<void> route(std::vector<PassInput> again, BoundedQueue<SampleBatch>& taken,
                     Processor& processor, Archive& archive, BoundedQueue<PassInput>& work) {
  for (PassInput& input : again) {
    work.push(std::move(input));
  }
  while (auto batch = taken.take()) {
    Routed routed = processor.route(std::move(*batch));
    if (auto stored = submit_all(archive, std::move(routed.samples)); !stored) {
      taken.close();  // Nobody empties it any more: the taking thread must not wait for room.
      return stored;
    }
    for (PassInput& input : routed.work) {
      work.push(std::move(input));
    }
  }
  return {};
}

/// Nobody waits for the solution of a minute, and everybody for fixes: it gets what processor time
/// they leave.
void give_way_to_other_threads() {
  const sched_param none{};
  const int failed = pthread_setschedparam(pthread_self(), SCHED_IDLE, &none);
  static std::once_flag said;
  if (failed != 0) {
    std::call_once(said, [failed] {
      spdlog::warn("batch solutions compete with fixes for the processor: {}",
                   std::generic_category().message(failed));
    });
  }
}

/// In a thread that does nothing else: one that gives way must not hold the archive's locks, and
/// without privileges none can cease to give way.
Expected<BatchSolution> solve_giving_way(const BatchTask& task) {
  return std::async(std::launch::async,
                    [&task] {
                      give_way_to_other_threads();
                      return solve(task);
                    })
      .get();
}

/// Solves until `tasks` is closed and empty, or patience ends: the end of a run has a solution of
/// its own.
void solve_batches(BoundedQueue<BatchTask>& tasks, Archive& archive, const Patience& patience) {
  std::map<std::string, std::string> said;
  while (const auto task = tasks.take()) {
    if (patience.ended) {
      continue;
    }
    auto solution = solve_giving_way(*task);
    if (!solution) {
      std::string& reason = said[task->spacecraft_id];
      if (std::exchange(reason, solution.error().message) != solution.error().message) {
        spdlog::warn("{}: no batch solution: {}", task->spacecraft_id, reason);
      }
    } else if (!archive.submit(archived(*task, *std::move(solution)))) {
      tasks.close();  // Those who compute meet the same archive, and say so.
    }
  }
}

/// Works until `work` is closed and empty, or the archive refuses.
/// @return samples that were left when patience ended.
Expected<std::size_t> compute(BoundedQueue<PassInput>& work, BoundedQueue<BatchTask>& tasks,
                              Processor& processor, Archive& archive, const Patience& patience) {
  std::size_t left = 0;
  while (const auto input = work.take()) {
    if (patience.ended) {
      left += sample_count(*input);
    } else if (auto stored = submit_all(archive, processor.compute(*input)); !stored) {
      work.close();  // Nobody empties it any more.
      return Unexpected{stored.error()};
    }
    for (BatchTask& task : processor.take_batch_tasks(*input)) {
      tasks.push(std::move(task));
    }
  }
  return left;
}

/// Both at once: samples reach the archive however long the mathematics takes. In the end runs are
/// finished of which all samples are computed.
Expected<void> route_and_compute(std::vector<PassInput> again, BoundedQueue<SampleBatch>& taken,
                                 BoundedQueue<PassInput>& work, Processor& processor,
                                 Archive& archive, const Patience& patience) {
  Expected<std::size_t> left;
  BoundedQueue<BatchTask> tasks{kBatchTasks};
  std::thread solving{[&] { solve_batches(tasks, archive, patience); }};
  std::thread computing{[&] { left = compute(work, tasks, processor, archive, patience); }};
  const auto routed = route(std::move(again), taken, processor, archive, work);
  work.close();
  computing.join();
  tasks.close();
  solving.join();
  if (!routed || !left) {
    return routed ? Unexpected{left.error()} : routed;
  }
  if (*left > 0) {
    spdlog::warn("{} samples are stored and not computed yet: the next start of the service will",
                 *left);
    return {};
  }
  return submit_all(archive, processor.finish());
}

/// A service that is told to stop waits a while for the mathematics, and while writing fails not at
/// all: it makes the last attempt now.
void lose_patience(const std::stop_token& done, Patience& patience,
                   BoundedQueue<SampleBatch>& queue, Archive& archive) {
  std::chrono::milliseconds waited{0};
  while (!done.stop_requested()) {
    if (patience.stopping && archive.statistics().failure) {
      queue.close();
      static_cast<void>(
          archive.close());  // What it could not store is said when it is closed again.
      return;
    }
    waited += patience.stopping ? kStuckPoll : std::chrono::milliseconds{0};
    patience.ended = waited >= kComputedWhenStopped;
    std::this_thread::sleep_for(kStuckPoll);
  }
}

/// From "ready" until a signal, or a failure, and everything taken is with the archive.
Expected<void> run(std::vector<PassInput> again, const bus::Participant& participant,
                   const ResultPublisher& publisher, Processor& processor, Archive& archive,
                   StopSignal& stop_signal) {
  BoundedQueue<SampleBatch> queue{kSamplesTaken,
                                  [](const SampleBatch& taken) { return sample_count(taken); }};
  BoundedQueue<PassInput> work{kSamplesToCompute,
                               [](const PassInput& input) { return sample_count(input); }};
  auto started = TelemetrySubscriber::start(participant, queue);
  if (!started) {
    return Unexpected{started.error()};
  }
  TelemetrySubscriber& subscriber = **started;
  Patience patience;
  stop_signal.on_stop([&] {
    spdlog::info("stopping");
    patience.stopping = true;
    subscriber.stop();
    queue.close();
  });
  const std::jthread watching{
      [&](const std::stop_token& done) { lose_patience(done, patience, queue, archive); }};
  Expected<void> worked;
  {
    const Heartbeat heartbeat{{.subscriber = subscriber,
                               .taken = queue,
                               .work = work,
                               .archive = archive,
                               .publisher = publisher},
                              &StopSignal::raise};
    spdlog::info("ready");
    worked = route_and_compute(std::move(again), queue, work, processor, archive, patience);
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
  return worked;
}

Expected<Processor> make_processor(const ServeOptions& options) {
  const auto missions = load_missions(options.missions);
  if (!missions) {
    return Unexpected{missions.error()};
  }
  return Processor::make(*missions, {.mode = options.partition == "replay" ? "replay" : "live",
                                     .telemetry = fmt::format("DDS domain {}, partition {}",
                                                              options.domain, options.partition)});
}

Expected<std::unique_ptr<Archive>> open_archive(const std::filesystem::path& db,
                                                Announcer& announcer) {
  return Archive::open(db, {.on_write_failure = OnWriteFailure::Retry,
                            .on_committed =
                                [&](std::span<const ArchiveBatch> stored) {
                                  announcer.committed(stored);
                                  warn_of_disagreements(db, stored);
                                },
                            .on_failure =
                                [](const Error& error) {
                                  spdlog::critical(
                                      "the archive does not store, nothing more is accepted: {}",
                                      error.message);
                                }});
}

}  // namespace

Expected<void> serve(const ServeOptions& options) {
  auto processor = make_processor(options);
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
  const auto opened = open_archive(options.db, announcer);
  if (!opened) {
    return Unexpected{opened.error()};
  }
  Archive& archive = **opened;
  spdlog::info("archive {}", options.db.string());

  const auto done = processor->go_on(options.db).and_then([&](Routed stored) {
    return submit_all(archive, std::move(stored.samples))
        .and_then([&] { return archive.flush(); })
        .and_then([&] {
          return run(std::move(stored.work), *participant, *publisher, *processor, archive,
                     stop_signal);
        });
  });
  if (auto outcome = outcome_of(done, archive.close()); !outcome) {
    return outcome;
  }
  return report(*processor, options.db, options.json).map([](const std::string& text) {
    fmt::print("{}", text);
  });
}

}  // namespace spindrift
