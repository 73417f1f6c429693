#include <fmt/format.h>
#include <malloc.h>
#include <poll.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>

#include "pipelines/core/shown.h"
#include "pipelines/time/utc.h"
#include "services/alerts/alert_desk.h"
#include "services/alerts/stored_alerts.h"
#include "services/alerts/webhook.h"
#include "services/archive/archive.h"
#include "services/archive/stored_results.h"
#include "services/archive/submit_all.h"
#include "services/base/contained.h"
#include "services/base/warning.h"
#include "services/bus/participant.h"
#include "services/ingest/other_services.h"
#include "services/ingest/rehearsal_clocks.h"
#include "services/mission/mission.h"
#include "services/operator/request_server.h"
#include "services/processor/problems.h"
#include "services/processor/processor.h"
#include "services/program/announcer.h"
#include "services/program/commands.h"
#include "services/program/comparison_notice.h"
#include "services/program/orbit_notice.h"
#include "services/program/outcome.h"
#include "services/program/requests.h"
#include "services/program/serve_console.h"
#include "services/program/service_terminal.h"
#include "services/program/summary_text.h"
#include "services/publisher/result_publisher.h"
#include "services/serving/action_inbox.h"
#include "services/serving/background_solving.h"
#include "services/serving/routing.h"
#include "services/serving/service_run.h"
#include "services/serving/stop_signal.h"
#include "services/serving/thread_failures.h"
#include "services/simulation/ground_model.h"

namespace spindrift {
namespace {

// Capacity of the queue between the receiving and the routing thread, in samples.
constexpr std::size_t kSamplesTaken = 65'536;
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
    return refused(problems);
  }
  return missions;
}

RunMode mode_of(const ServeOptions& options) {
  return options.partition == "replay" ? RunMode::Replay : RunMode::Live;
}

std::string host_name() {
  std::array<char, 48> host{};
  if (::gethostname(host.data(), host.size() - 1) != 0) {
    host = {"unknown"};
  }
  return host.data();
}

std::string service_name() { return fmt::format("spindrift {}:{}", host_name(), ::getpid()); }

Expected<Told> listen(const bus::Participant& participant) {
  return OtherServices::create(participant, service_name()).and_then([&](OtherServices&& others) {
    return RehearsalClocks::create(participant).map([&](RehearsalClocks&& clocks) {
      return Told{.others = std::move(others), .clocks = std::move(clocks)};
    });
  });
}

std::size_t taken_size(const SampleBatch& taken) {
  return std::max<std::size_t>(size_of(taken), 1);
}

/// Logs actions left in an unread queue, which their senders believe accepted.
void tell_actions_left(BoundedQueue<SampleBatch>& taken) {
  taken.close();
  while (const auto batch = taken.take()) {
    for (const OperatorAction& action : batch->actions) {
      spdlog::error("{}: {} of {} ({}) is not stored and not done: say it again", action.spacecraft,
                    action.action, shown(action.by), action.action_id);
    }
  }
}

/// Answers requests of other programs while this one holds the archive.
Expected<std::unique_ptr<RequestServer>> answer_requests(const std::filesystem::path& db,
                                                         Archive& archive, AlertDesk& desk,
                                                         ActionInbox& inbox) {
  const auto behind_samples = [](RequestServer::Answer answer) -> RequestServer::Answer {
    return [answer = std::move(answer)](const nlohmann::json& request) {
      let_samples_come_first();
      return answer(request);
    };
  };
  auto server = RequestServer::start(
      db,
      {{std::string{kAlertRequest}, behind_samples([&](const nlohmann::json& request) {
          return answer_alert(request, desk, archive);
        })},
       {std::string{kActionRequest}, behind_samples([&](const nlohmann::json& request) {
          return answer_action(request, inbox);
        })},
       {std::string{kReconstructRequest}, behind_samples([&, db](const nlohmann::json& request) {
          return answer_reconstruct(request, db, archive);
        })}});
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

void tell_models(const GroundModels& models) {
  for (const auto& [spacecraft, model] : models) {
    const ModelSpan span = span_of(*model);
    spdlog::info("{}: held against its ground model from {} to {}", spacecraft,
                 format_utc(span.from, 0), format_utc(span.to, 0));
  }
}

/// Returns null in a rehearsal, whose alerts must not wake anybody.
Expected<std::unique_ptr<Webhook>> start_webhook(const ServeOptions& options,
                                                 const AlertDesk& desk) {
  if (options.webhook.empty()) {
    return nullptr;
  }
  if (mode_of(options) != RunMode::Live) {
    spdlog::info("a rehearsal: nothing is told to {}", shown(options.webhook));
    return nullptr;
  }
  return Webhook::start(options.webhook, desk,
                        fmt::format("spindrift {} {}", host_name(), options.partition));
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
                                                DisagreementNotices& disagreements,
                                                StoredActions& actions, ThreadFailures& failures) {
  return Archive::open(db, {.on_write_failure = OnWriteFailure::Retry,
                            .on_submit = [&](ArchiveBatch& batch) { desk.evaluate(batch); },
                            .on_refused = [&](const ArchiveBatch& batch) { desk.take_back(batch); },
                            .on_committed =
                                [&](std::span<const ArchiveBatch> stored) {
                                  desk.note_stored(stored);
                                  actions.confirm(stored);
                                  failures.report(contained("announcing", [&] {
                                    announcer.committed(stored);
                                    disagreements.tell(stored);
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

/// Tells `announcer` what the continued runs have announced; call it before they continue.
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

/// Restores runs of spacecraft whose next run has not begun, without announcing them.
Expected<void> take_up_last_runs(const std::filesystem::path& db,
                                 const std::map<std::string, LastRun>& last_runs, AlertDesk& desk,
                                 ConsoleFeed* feed) {
  for (const auto& [spacecraft, last] : last_runs) {
    desk.take_up_run(spacecraft, last.run_id);
    if (feed == nullptr) {
      continue;
    }
    const auto results = find_stored_results(db, last.run_id);
    if (!results) {
      return Unexpected{results.error()};
    }
    feed->put(spacecraft, last.run_id, results->in_force());
  }
  return {};
}

/// Restores open alerts before anything is computed, and how many changes there were, only of runs
/// of the same mode: alerts left open by a rehearsal must not wake anybody.
Expected<void> take_up_alerts(const std::filesystem::path& db, RunMode mode, AlertDesk& desk,
                              ConsoleFeed* feed) {
  return find_alerts(db)
      .map([&](const std::vector<StoredAlert>& alerts) {
        for (const StoredAlert& stored : alerts) {
          if (stored.mode == mode) {
            desk.take_up(stored.spacecraft, stored.run_id, stored.alert);
            if (feed != nullptr) {
              feed->put(stored);
            }
          }
        }
      })
      .and_then([&] { return find_transitions(db, mode); })
      .map([&](const std::vector<StoredTransition>& transitions) {
        for (const auto& [spacecraft, t] : transitions) {
          desk.take_up_transition(spacecraft, t);
        }
      });
}

/// A full pipe without a reader must not block a stopped service.
Expected<void> print_if_read(const std::string& text) {
  pollfd out{.fd = STDOUT_FILENO, .events = POLLOUT, .revents = 0};
  if (::poll(&out, 1, kUntilRead_ms) == 0) {
    return Unexpected{{ErrorCode::Unavailable, "standard output: nobody reads it"}};
  }
  fmt::print("{}", text);
  return {};
}

void show(const Health& health, ServiceTerminal& terminal, ConsoleFeed* feed) {
  terminal.show(health);
  if (feed != nullptr) {
    feed->put(health);
  }
}

/// Makes all threads share four heaps. What one thread takes another frees, so that with a heap for
/// each thread, as by default, most of the memory would be free and of no use to the others; with
/// fewer the threads wait for each other.
void share_heaps() { mallopt(M_ARENA_MAX, 4); }

/// Continues the stored runs and alerts and submits the routed samples to the archive again.
Expected<GoneOn> go_on(const ServiceParts& parts, ConsoleFeed* feed, Announcer& announcer) {
  return parts.processor.arrive_after(parts.db)
      .and_then([&] { return take_up_alerts(parts.db, parts.mode, parts.desk, feed); })
      .and_then([&] {
        return parts.processor.go_on(parts.db, moment_of(parts.processor, parts.told.clocks));
      })
      .and_then([&](GoneOn stored) {
        return take_up_last_runs(parts.db, stored.last_runs, parts.desk, feed)
            .and_then([&] { return note_announced(parts.db, stored.routed.samples, announcer); })
            .and_then([&] { return submit_all(parts.archive, std::move(stored.routed.samples)); })
            .and_then([&] { return parts.archive.flush(); })
            .map([&] { return std::move(stored); });
      });
}

/// Takes telemetry and answers requests, until a signal or a failure.
Expected<void> take_and_answer(const ServeOptions& options, const ServiceParts& parts,
                               ConsoleFeed* feed, ServiceTerminal& terminal, StoredActions& actions,
                               GoneOn stored) {
  ActionInbox inbox{
      known_spacecraft(parts.missions), parts.db, parts.mode, parts.archive, parts.taken, actions};
  const auto requests = answer_requests(options.db, parts.archive, parts.desk, inbox);
  const auto console = start_console(options, feed, parts, inbox);
  if (!console) {
    return Unexpected{console.error()};
  }
  auto ran = run_service(std::move(stored), parts);
  terminal.erase();
  tell_actions_left(parts.taken);
  // Closing the archive answers clients that still wait for it, so that the servers can end.
  static_cast<void>(parts.archive.close());
  return ran;
}

}  // namespace

Expected<void> serve(const ServeOptions& options) {
  share_heaps();
  const TellAs tell_as = how_to_tell(options.json);
  if (tell_as == TellAs::JsonLines) {
    log_as_json();
  }
  // The processor lives to the end of the process because an abandoned solution may still use it.
  const auto missions = load_missions(options.missions);
  static auto processor = make_processor(options, missions);
  if (!processor) {
    return Unexpected{processor.error()};
  }
  if (auto checked = check_console(options); !checked) {
    return checked;
  }
  const auto models = load_ground_models(*missions);
  if (!models) {
    return Unexpected{models.error()};
  }
  tell_models(*models);
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
  Bell new_answers;
  const auto feed = make_console_feed(options, *missions, service_name());
  ServiceTerminal terminal{*missions, tell_as};
  Announcer announcer{*publisher, feed.get(), terminal, new_answers, failures};
  AlertDesk desk{*missions, mode_of(options), *models};
  const auto webhook = start_webhook(options, desk);
  if (!webhook) {
    return Unexpected{webhook.error()};
  }
  DisagreementNotices disagreements{options.db};
  StoredActions actions;
  const auto opened =
      open_archive(options.db, desk, announcer, problems, disagreements, actions, failures);
  if (!opened) {
    return Unexpected{opened.error()};
  }
  Archive& archive = **opened;
  spdlog::info("archive {}", options.db.string());

  BoundedQueue<SampleBatch> taken{kSamplesTaken, &taken_size};
  const ServiceParts parts{
      .missions = *missions,
      .mode = mode_of(options),
      .db = options.db,
      .participant = *participant,
      .publisher = *publisher,
      .told = *told,
      .taken = taken,
      .processor = *processor,
      .archive = archive,
      .desk = desk,
      .webhook = webhook->get(),
      .problems = problems,
      .stop_signal = stop_signal,
      .failures = failures,
      .new_answers = new_answers,
      .announce = [&](const ArchiveBatch& batch) { announcer.announce(batch); },
      .on_health = [&](const Health& health) { show(health, terminal, feed.get()); },
      .on_verdict =
          [&](const std::string& spacecraft, const std::string& run_id,
              const PassVerdict& verdict) {
            if (feed != nullptr) {
              show_verdict(*feed, spacecraft, run_id, verdict, desk);
            }
          },
      .on_finished = [&] { return disagreements.store(archive); }};
  const auto done = go_on(parts, feed.get(), announcer).and_then([&](GoneOn stored) {
    return take_and_answer(options, parts, feed.get(), terminal, actions, std::move(stored));
  });
  if (auto outcome = outcome_of(done, archive.close()); !outcome) {
    return outcome;
  }
  return report(*processor, options.db, options.json).and_then(&print_if_read);
}

}  // namespace spindrift
