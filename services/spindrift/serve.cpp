#include "services/spindrift/serve.h"

#include <fmt/format.h>
#include <poll.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>
#include <variant>

#include "pipelines/core/shown.h"
#include "pipelines/time/utc.h"
#include "services/alerts/alert_desk.h"
#include "services/alerts/stored_alerts.h"
#include "services/archive/archive.h"
#include "services/archive/stored_results.h"
#include "services/archive/submit_all.h"
#include "services/bus/participant.h"
#include "services/clock/wall_clock.h"
#include "services/ingest/other_services.h"
#include "services/ingest/rehearsal_clocks.h"
#include "services/ingest/telemetry_subscriber.h"
#include "services/mission/mission.h"
#include "services/processor/problems.h"
#include "services/processor/processor.h"
#include "services/processor/silence_watch.h"
#include "services/publisher/link_watch.h"
#include "services/publisher/result_publisher.h"
#include "services/queue/contained.h"
#include "services/requests/request_server.h"
#include "services/serving/action_inbox.h"
#include "services/serving/alert_outbox.h"
#include "services/serving/background_solving.h"
#include "services/serving/computing.h"
#include "services/serving/heartbeat.h"
#include "services/serving/patience.h"
#include "services/serving/service_manager.h"
#include "services/serving/service_watch.h"
#include "services/serving/session_watch.h"
#include "services/serving/stop_signal.h"
#include "services/serving/thread_failures.h"
#include "services/spindrift/act.h"
#include "services/spindrift/alerts.h"
#include "services/spindrift/announcer.h"
#include "services/spindrift/comparison_notice.h"
#include "services/spindrift/orbit_notice.h"
#include "services/spindrift/outcome.h"
#include "services/spindrift/reconstruct.h"
#include "services/spindrift/serve_console.h"
#include "services/spindrift/summary_text.h"
#include "services/standard_error/warning.h"
#include "services/webhook/webhook.h"

namespace spindrift {
namespace {

// Samples between the thread that takes and the one that routes.
constexpr std::size_t kSamplesTaken = 65'536;
// Samples that wait to be computed: a whole day's pass in a burst.
constexpr std::size_t kSamplesToCompute = 1'000'000;
constexpr std::chrono::milliseconds kStuckPoll{200};
// A backlog of what was stored is computed for so long after the signal to stop. What is left then
// is computed at the next start.
constexpr std::chrono::seconds kComputedWhenStopped{8};
constexpr int kUntilRead_ms = 1000;

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

RunMode mode_of(const ServeOptions& options) {
  return options.partition == "replay" ? RunMode::Replay : RunMode::Live;
}

KnownSpacecraft kinds_of(const std::vector<Mission>& missions) {
  KnownSpacecraft known;
  for (const Mission& mission : missions) {
    known.emplace(mission.spacecraft_id, mission.kind());
  }
  return known;
}

std::string service_name() {
  std::array<char, 48> host{};
  if (::gethostname(host.data(), host.size() - 1) != 0) {
    host = {"unknown"};
  }
  return fmt::format("spindrift {}:{}", host.data(), ::getpid());
}

/// What others on the bus say beside telemetry.
struct Told {
  OtherServices others;
  RehearsalClocks clocks;
};

Expected<Told> listen(const bus::Participant& participant) {
  return OtherServices::create(participant, service_name()).and_then([&](OtherServices&& others) {
    return RehearsalClocks::create(participant).map([&](RehearsalClocks&& clocks) {
      return Told{.others = std::move(others), .clocks = std::move(clocks)};
    });
  });
}

/// What came, for those who watch the link.
struct Heard {
  LinkWatch links;
  SessionWatch sessions;
};

/// Before the archive may make them wait.
void note_arrivals(const std::vector<ArchiveBatch>& samples, Heard& heard, SilenceWatch& silences) {
  const auto now = std::chrono::steady_clock::now();
  for (const ArchiveBatch& batch : samples) {
    heard.sessions.note(batch);
    const auto note = [&](const auto& of_kind) {
      // A sample that is left out has a negative one.
      const auto last = std::find_if(of_kind.rbegin(), of_kind.rend(),
                                     [](const auto& sample) { return sample.arrival >= 0; });
      if (last != of_kind.rend()) {
        heard.links.note(batch.spacecraft_id, last->value.t, now);
        silences.note(batch.spacecraft_id, now);
      }
    };
    batch.samples.for_each(note);
    batch.moved.for_each(note);
  }
}

/// The clock of the host says something of samples of now only.
Moment moment_of(const Processor& processor) {
  return {.now = std::chrono::steady_clock::now(),
          .host = processor.is_live() ? std::optional{tai_now()} : std::nullopt};
}

/// What is taken next; or that streams are silent, which only holds while nothing waits in `taken`.
Routed next_routed(BoundedQueue<SampleBatch>& taken, Processor& processor, Heard& heard,
                   SilenceWatch& silences) {
  const auto next_silence = silences.next();
  const auto next_decision = processor.next_decision();
  const auto next = next_silence && next_decision ? std::min(next_silence, next_decision)
                                                  : std::max(next_silence, next_decision);
  auto batch = next ? taken.take_until(*next) : taken.take();
  const Moment moment = moment_of(processor);
  Routed routed = batch ? processor.route(std::move(*batch), moment)
                        : processor.fall_silent(silences.take_silent(moment.now), moment);
  note_arrivals(routed.samples, heard, silences);
  return routed;
}

/// First `again`. Then hands what is taken to the archive and on to be computed, until `taken` is
/// closed and empty, or the archive refuses.
Expected<void> route(std::vector<PassInput> again, BoundedQueue<SampleBatch>& taken,
                     Processor& processor, Archive& archive, Computing& computing, Heard& heard,
                     Problems& problems) {
  for (PassInput& input : again) {
    computing.leave_to_backlog(std::move(input));
  }
  SilenceWatch silences;
  while (!taken.is_drained()) {
    Routed routed = next_routed(taken, processor, heard, silences);
    problems.set_sources(processor.source_problems());
    auto stored = submit_all(archive, std::move(routed.samples));
    for (auto input = routed.work.begin(); stored && input != routed.work.end(); ++input) {
      stored = computing.take(std::move(*input), taken.size());
    }
    if (!stored) {
      return stored;
    }
  }
  return {};
}

/// Spacecraft by spacecraft, as long as patience lasts.
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

/// In the end runs are finished of which all samples are computed and all solutions made. Who can
/// no longer empty a queue closes it: nobody must wait for room.
void route_and_compute(std::vector<PassInput> again, BoundedQueue<SampleBatch>& taken,
                       BoundedQueue<PassInput>& backlog, Processor& processor, Archive& archive,
                       const Patience& patience, Heard& heard, Problems& problems,
                       ThreadFailures& failures) {
  BackgroundTasks tasks;
  Computing computing{processor, archive, backlog, tasks, patience};
  std::atomic<std::size_t> solutions_left = 0;
  const auto solve = [&](BoundedQueue<BackgroundTask>& of) {
    failures.note(contained("solving",
                            [&] { solutions_left += solve_in_background(of, archive, patience); }));
    of.close();
  };
  std::thread solving{[&] { solve(tasks.usual); }};
  std::thread solving_awaited{[&] { solve(tasks.awaited); }};
  std::thread working_off{[&] {
    failures.note(contained("computing the backlog", [&] { return computing.work_off(); }));
    backlog.close();
  }};
  failures.note(contained("taking in", [&] {
    return route(std::move(again), taken, processor, archive, computing, heard, problems);
  }));
  taken.close();
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
  failures.note(contained("finishing", [&] { return finish(processor, archive, patience); }));
}

/// A service that is told to stop waits a while for the mathematics, and while writing fails not at
/// all: it makes the last attempt now.
void lose_patience(const std::stop_token& done, Patience& patience,
                   BoundedQueue<SampleBatch>& queue, Archive& archive) {
  std::optional<std::chrono::steady_clock::time_point> until;
  while (!done.stop_requested()) {
    if (patience.stopping && archive.statistics().failure) {
      queue.close();
      static_cast<void>(
          archive.close());  // What it could not store is said when it is closed again.
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

/// Of a subscriber that was stopped.
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

/// What was stored before a restart, for those who watch what comes.
void note_stored(const std::vector<PassInput>& again, const LastOrigins& last_origins,
                 const Processor& processor, SessionWatch& sessions, AlertDesk& desk) {
  const auto spacecraft = processor.spacecraft();
  std::map<std::string, TaiTime> newest;
  for (const PassInput& input : again) {
    const std::string& id = spacecraft.at(input.spacecraft);
    input.values.for_each([&](const auto& of_kind) {
      for (const auto& arrived : of_kind) {
        TaiTime& last = newest.try_emplace(id, arrived.value.t).first->second;
        last = std::max(last, arrived.value.t);
      }
    });
    desk.go_on(id, input.run_id, input.values);
  }
  for (const auto& [id, t] : newest) {
    sessions.go_on(id, last_origins, t);
  }
}

std::size_t taken_size(const SampleBatch& taken) {
  return std::max<std::size_t>(size_of(taken), 1);
}

/// From "ready" until a signal, or a failure, and everything taken is with the archive.
/// @param queue Of what is taken.
Expected<void> run(std::vector<PassInput> again, const LastOrigins& last_origins,
                   BoundedQueue<SampleBatch>& queue, const ServeOptions& options,
                   const std::vector<Mission>& missions, const bus::Participant& participant,
                   const ResultPublisher& publisher, Told& told, Processor& processor,
                   Archive& archive, AlertDesk& desk, Announcer& announcer, Problems& problems,
                   ConsoleFeed* feed, StopSignal& stop_signal, ThreadFailures& failures) {
  BoundedQueue<PassInput> work{kSamplesToCompute,
                               [](const PassInput& input) { return sample_count(input); }};
  const auto spacecraft = processor.spacecraft();
  auto started = TelemetrySubscriber::start(participant, queue,
                                            {spacecraft.begin(), spacecraft.end()}, last_origins);
  if (!started) {
    return Unexpected{started.error()};
  }
  TelemetrySubscriber& subscriber = **started;
  Heard heard{.links = LinkWatch{processor.spacecraft()}, .sessions = {}};
  note_stored(again, last_origins, processor, heard.sessions, desk);
  Patience patience;
  stop_signal.on_stop([&] {
    tell_manager_stopping();
    spdlog::info("stopping");
    patience.stopping = true;
    failures.note(contained("stopping", [&] { subscriber.stop(); }));
    queue.close();
  });
  const std::jthread watching{[&](const std::stop_token& done) {
    failures.note(
        contained("watching the stop", [&] { lose_patience(done, patience, queue, archive); }));
  }};
  {
    AlertOutbox outbox{archive, desk, [&](const ArchiveBatch& batch) { announcer.announce(batch); },
                       failures};
    ServiceWatch service{{.missions = missions,
                          .mode = mode_of(options),
                          .db = options.db,
                          .archive = archive,
                          .taken = queue,
                          .links = heard.links,
                          .sessions = heard.sessions,
                          .others = told.others,
                          .clocks = told.clocks}};
    const Heartbeat heartbeat{{.subscriber = subscriber,
                               .taken = queue,
                               .work = work,
                               .archive = archive,
                               .publisher = publisher,
                               .links = heard.links,
                               .problems = problems,
                               .service = service,
                               .desk = desk,
                               .outbox = outbox,
                               .on_health =
                                   [&](const Health& health) {
                                     if (feed != nullptr) {
                                       feed->put(health);
                                     }
                                   }},
                              failures};
    tell_manager_ready();
    spdlog::info("ready");
    route_and_compute(std::move(again), queue, work, processor, archive, patience, heard, problems,
                      failures);
  }
  stop_signal.join();
  const auto taking = how_taking_ended(subscriber);
  return failures.first().and_then([&] { return taking; });
}

/// Of a queue that nobody empties any more. Whoever said them takes them for taken.
void tell_actions_left(BoundedQueue<SampleBatch>& taken) {
  taken.close();
  while (const auto batch = taken.take()) {
    for (const OperatorAction& action : batch->actions) {
      spdlog::error("{}: {} of {} ({}) is not stored and not done: say it again", action.spacecraft,
                    action.action, shown(action.by), action.action_id);
    }
  }
}

/// What other programs ask while this one holds the archive. Where they cannot it is said.
Expected<std::unique_ptr<RequestServer>> answer_requests(const std::filesystem::path& db,
                                                         Archive& archive, AlertDesk& desk,
                                                         ActionInbox& inbox) {
  auto server = RequestServer::start(db, [&](const nlohmann::json& request) {
    let_samples_come_first();
    const std::string what = request.value("do", "");
    if (what == kAlertRequest) {
      return answer_alert(request, desk, archive);
    }
    if (what == kActionRequest) {
      return answer_action(request, inbox);
    }
    return what == kReconstructRequest
               ? answer_reconstruct(request, db, archive)
               : nlohmann::json{{"error", "not known here: do = reconstruct, alert, action are"}};
  });
  if (!server) {
    warn("no_requests", {{"why", server.error().message}},
         fmt::format(
             "`reconstruct`, `alerts ack` and `act` have to wait until this service ends: {}",
             server.error().message));
  }
  return server;
}

Expected<Processor> make_processor(const ServeOptions& options,
                                   const Expected<std::vector<Mission>>& missions) {
  if (!missions) {
    return Unexpected{missions.error()};
  }
  return Processor::make(*missions,
                         {.mode = mode_of(options),
                          .telemetry = {fmt::format("DDS domain {}, partition {}", options.domain,
                                                    options.partition)}});
}

/// None of a rehearsal: its alerts must not wake anybody.
Expected<std::unique_ptr<Webhook>> start_webhook(const ServeOptions& options,
                                                 const AlertDesk& desk) {
  if (options.webhook.empty()) {
    return nullptr;
  }
  if (mode_of(options) != RunMode::Live) {
    spdlog::info("a rehearsal: nothing is told to {}", shown(options.webhook));
    return nullptr;
  }
  return Webhook::start(options.webhook, desk, service_name());
}

void note_faults(std::span<const ArchiveBatch> stored, Problems& problems) {
  for (const ArchiveBatch& batch : stored) {
    for (const Product& product : batch.products) {
      if (const auto* const fault = std::get_if<RunFault>(&product)) {
        problems.add_fault(fmt::format("{}: computing failed at {}: {}: run {} is DOUBTFUL",
                                       batch.spacecraft_id, format_utc(fault->t), fault->what,
                                       batch.run_id));
      }
    }
  }
}

Expected<std::unique_ptr<Archive>> open_archive(const std::filesystem::path& db, AlertDesk& desk,
                                                Announcer& announcer, Problems& problems,
                                                ThreadFailures& failures) {
  return Archive::open(db, {.on_write_failure = OnWriteFailure::Retry,
                            .on_submit = [&](ArchiveBatch& batch) { desk.see(batch); },
                            .on_refused = [&](const ArchiveBatch& batch) { desk.take_back(batch); },
                            .on_committed =
                                [&](std::span<const ArchiveBatch> stored) {
                                  desk.note_stored(stored);
                                  failures.note(contained("announcing", [&] {
                                    announcer.committed(stored);
                                    warn_of_disagreements(db, stored);
                                    note_faults(stored, problems);
                                  }));
                                },
                            .on_failure =
                                [](const Error& error) {
                                  spdlog::critical(
                                      "the archive does not store, nothing more is accepted: {}",
                                      error.message);
                                }});
}

/// Of the runs that go on, before they do.
Expected<void> note_announced(const std::filesystem::path& db,
                              const std::vector<ArchiveBatch>& going_on, Announcer& announcer) {
  for (const ArchiveBatch& batch : going_on) {
    if (!batch.continuation) {
      continue;
    }
    auto results = find_stored_results(db, batch.run_id);
    if (!results) {
      return Unexpected{results.error()};
    }
    announcer.go_on(batch.run_id, batch.spacecraft_id, *std::move(results));
  }
  return {};
}

/// Those of the runs of such services, before anything is computed: what a rehearsal has left open
/// must not wake anybody.
Expected<void> take_up_alerts(const std::filesystem::path& db, RunMode mode, AlertDesk& desk,
                              ConsoleFeed* feed) {
  return find_alerts(db).map([&](const std::vector<StoredAlert>& alerts) {
    for (const StoredAlert& stored : alerts) {
      if (stored.mode == mode) {
        desk.take_up(stored.spacecraft, stored.run_id, stored.alert);
        if (feed != nullptr) {
          feed->put(stored);
        }
      }
    }
  });
}

/// A pipe that is full and that nobody reads must not keep a service that has stopped.
Expected<void> print_if_read(const std::string& text) {
  pollfd out{.fd = STDOUT_FILENO, .events = POLLOUT, .revents = 0};
  if (::poll(&out, 1, kUntilRead_ms) == 0) {
    return Unexpected{{ErrorCode::Unavailable, "standard output: nobody reads it"}};
  }
  fmt::print("{}", text);
  return {};
}

}  // namespace

Expected<void> serve(const ServeOptions& options) {
  // To the end of the process: a solution that was given up may still use it.
  const auto missions = load_missions(options.missions);
  static auto processor = make_processor(options, missions);
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
  const auto publisher = ResultPublisher::create(*participant, service_name());
  if (!publisher) {
    return Unexpected{publisher.error()};
  }
  auto told = listen(*participant);
  if (!told) {
    return Unexpected{told.error()};
  }
  ThreadFailures failures;
  Problems problems;
  const auto feed = make_console_feed(options, *missions, service_name());
  Announcer announcer{*publisher, feed.get(), failures};
  AlertDesk desk{*missions, mode_of(options)};
  const auto webhook = start_webhook(options, desk);
  if (!webhook) {
    return Unexpected{webhook.error()};
  }
  const auto opened = open_archive(options.db, desk, announcer, problems, failures);
  if (!opened) {
    return Unexpected{opened.error()};
  }
  Archive& archive = **opened;
  spdlog::info("archive {}", options.db.string());

  auto gone_on =
      processor->arrive_after(options.db)
          .and_then([&] { return take_up_alerts(options.db, mode_of(options), desk, feed.get()); })
          .and_then([&] { return processor->go_on(options.db, moment_of(*processor)); });
  const auto done = std::move(gone_on).and_then([&](GoneOn stored) {
    return note_announced(options.db, stored.routed.samples, announcer)
        .and_then([&] { return submit_all(archive, std::move(stored.routed.samples)); })
        .and_then([&] { return archive.flush(); })
        .and_then([&] {
          BoundedQueue<SampleBatch> taken{kSamplesTaken, &taken_size};
          ActionInbox inbox{kinds_of(*missions), archive, taken};
          const auto requests = answer_requests(options.db, archive, desk, inbox);
          const auto console = start_console(options, feed.get(), desk, archive, inbox);
          if (!console) {
            return Expected<void>{Unexpected{console.error()}};
          }
          auto ran = run(std::move(stored.routed.work), stored.last_origins, taken, options,
                         *missions, *participant, *publisher, *told, *processor, archive, desk,
                         announcer, problems, feed.get(), stop_signal, failures);
          tell_actions_left(taken);
          // Who asks and waits for the archive gets his answer, so that the servers can end.
          static_cast<void>(archive.close());
          return ran;
        });
  });
  if (auto outcome = outcome_of(done, archive.close()); !outcome) {
    return outcome;
  }
  return report(*processor, options.db, options.json).and_then(&print_if_read);
}

}  // namespace spindrift
