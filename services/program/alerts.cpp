#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include "pipelines/core/shown.h"
#include "pipelines/time/utc.h"
#include "services/alerts/alert_desk.h"
#include "services/alerts/alert_json.h"
#include "services/alerts/stored_alerts.h"
#include "services/archive/connection.h"
#include "services/base/json_line.h"
#include "services/base/wall_clock.h"
#include "services/base/warning.h"
#include "services/operator/request_socket.h"
#include "services/products/products.h"
#include "services/program/commands.h"
#include "services/program/outcome.h"
#include "services/program/requests.h"
#include "services/serving/stop_signal.h"

namespace spindrift {
namespace {

constexpr std::chrono::milliseconds kPoll{100};

/// The run mode is shown because a service changes only alerts of its own mode.
std::string to_text(const StoredAlert& stored) {
  const Alert& alert = stored.alert;
  const std::string until =
      alert.cleared ? fmt::format(" until {}", format_utc(*alert.cleared)) : std::string{};
  const std::string accepted = alert.accepted
                                   ? fmt::format(", accepted by {} {}", shown(alert.accepted->by),
                                                 format_utc(alert.accepted->t))
                                   : std::string{};
  const std::string often =
      alert.count > 1 ? fmt::format(", count {}", alert.count) : std::string{};
  return fmt::format("{} {} {} {} {} since {}{}{}{}, {} run: {}\n", alert.alert_id,
                     stored.spacecraft, name_of(alert.severity), name_of(alert.state), alert.key,
                     format_utc(alert.raised), until, often, accepted, name_of(stored.mode),
                     alert.message);
}

nlohmann::json json_of(const StoredAlert& stored) {
  nlohmann::json object = alert_json(stored.spacecraft, stored.run_id, stored.alert);
  object["mode"] = name_of(stored.mode);
  return object;
}

/// Prints alerts with a new revision. @param first Whether cleared alerts are skipped.
void tell_changes(const std::vector<StoredAlert>& alerts, bool json, bool first,
                  std::map<std::string, std::int64_t>& told) {
  for (const StoredAlert& stored : alerts) {
    const std::int64_t revision = stored.alert.revision;
    std::int64_t& before = told.try_emplace(stored.alert.alert_id, 0).first->second;
    const bool is_over = first && stored.alert.state == AlertState::Cleared;
    if (std::exchange(before, revision) != revision && !is_over) {
      fmt::print("{}", json ? json_line(json_of(stored)) : to_text(stored));
    }
  }
}

nlohmann::json changed_json(const ArchiveBatch& batch) {
  return alert_json(batch.spacecraft_id, batch.run_id, std::get<Alert>(batch.products.front()));
}

void print_changed(const nlohmann::json& alert, bool json) {
  fmt::print("{}", json ? json_line(with_warnings(alert))
                        : fmt::format("{} {} {}\n", alert.value("alert_id", ""),
                                      alert.value("key", ""), alert.value("state", "")));
}

/// A refused alert may still be in the archive, under a run of another mode.
std::string why_refused(const AlertsOptions& options, const nlohmann::json& answer) {
  const std::string mode = answer.value("mode", "");
  for (const StoredAlert& stored : find_alerts(options.db).value_or(std::vector<StoredAlert>{})) {
    if (stored.alert.alert_id == options.alert_id && stored.alert.state != AlertState::Cleared &&
        name_of(stored.mode) != mode) {
      return fmt::format(
          "alert '{}' is of a {} run, and a service that runs {} holds the archive: say it again "
          "when that has ended",
          options.alert_id, name_of(stored.mode), mode);
    }
  }
  return answer.value("error", "");
}

/// Opens the archive before reading the alert, so that no other writer can change it in between.
Expected<nlohmann::json> changed_here(const AlertsOptions& options) {
  auto archive = find_alerts(options.db).and_then([&](const auto& /*an archive it is*/) {
    return Archive::open(options.db, {});
  });
  if (!archive) {
    return Unexpected{archive.error()};
  }
  const auto stored = find_alerts(options.db);
  if (!stored) {
    return Unexpected{stored.error()};
  }
  AlertDesk desk;
  for (const StoredAlert& one : *stored) {
    desk.take_up(one.spacecraft, one.run_id, one.alert);
  }
  const auto taken = take_word({.alert_id = options.alert_id,
                                .by = options.by,
                                .note = options.note,
                                .minutes = options.minutes},
                               desk, **archive);
  if (!taken && taken.error().code == ErrorCode::InvalidInput) {
    return refused(taken.error().message);
  }
  const auto stored_word = taken.map([](const ArchiveBatch& /*stored*/) {});
  return outcome_of(stored_word, (*archive)->close()).map([&] { return changed_json(*taken); });
}

}  // namespace

Expected<void> list_alerts(const AlertsOptions& options) {
  return find_alerts(options.db).map([&](const std::vector<StoredAlert>& alerts) {
    nlohmann::json all = nlohmann::json::array();
    for (const StoredAlert& stored : alerts) {
      if (options.json) {
        all.push_back(json_of(stored));
      } else {
        fmt::print("{}", to_text(stored));
      }
    }
    if (options.json) {
      fmt::print("{}", json_line(with_warnings({{"alerts", std::move(all)}})));
    }
  });
}

Expected<void> follow_alerts(const AlertsOptions& options) {
  StopSignal signal;
  std::atomic<bool> stopped = false;
  signal.on_stop([&] { stopped = true; });
  const auto follow = [&](SQLite::Database& archive) {
    std::map<std::string, std::int64_t> told;  // Revision printed last, by alert id.
    std::optional<int> seen;
    bool is_read = true;
    for (; is_read && !stopped; std::this_thread::sleep_for(kPoll)) {
      const int commits = archive.execAndGet("PRAGMA data_version").getInt();
      if (commits != seen) {
        tell_changes(alerts_in(archive), options.json, !seen, told);
        is_read = std::fflush(stdout) == 0;
        seen = commits;
      }
    }
    return is_read;
  };
  return read_archive(options.db, follow).map([](bool /*is_read*/) {});
}

Expected<void> change_alert(const AlertsOptions& options) {
  const auto answer = ask_holder(options.db, {{"do", kAlertRequest},
                                              {"alert_id", options.alert_id},
                                              {"by", options.by},
                                              {"note", options.note},
                                              {"minutes", options.minutes}});
  if (!answer) {
    return Unexpected{answer.error()};
  }
  if (!*answer) {
    return changed_here(options).map(
        [&](const nlohmann::json& alert) { print_changed(alert, options.json); });
  }
  if ((**answer).contains("error")) {
    return refused(why_refused(options, **answer));
  }
  print_changed((**answer).at("alert"), options.json);
  return {};
}

nlohmann::json answer_alert(const nlohmann::json& request, AlertDesk& desk, Archive& archive) {
  const auto taken = take_word({.alert_id = request.value("alert_id", ""),
                                .by = request.value("by", ""),
                                .note = request.value("note", ""),
                                .minutes = request.value("minutes", 0)},
                               desk, archive);
  return taken ? nlohmann::json{{"alert", changed_json(*taken)}}
               : nlohmann::json{{"error", taken.error().message}, {"mode", name_of(desk.mode())}};
}

}  // namespace spindrift
