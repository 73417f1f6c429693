#include "services/console/console_feed.h"

#include <fmt/format.h>

#include <string_view>
#include <type_traits>
#include <variant>

#include "pipelines/time/utc.h"
#include "services/alerts/alert_json.h"
#include "services/base/wall_clock.h"
#include "services/console/go_no_go.h"

namespace spindrift {
namespace {

// Health normally comes every second.
constexpr std::chrono::seconds kNoHealthFor{10};

template <class Kind>
constexpr std::string_view kEvent = std::is_same_v<Kind, SpinEstimate>       ? "estimate"
                                    : std::is_same_v<Kind, SpinFix>          ? "fix"
                                    : std::is_same_v<Kind, AttitudeEstimate> ? "attitude"
                                                                             : "";

/// Larger than all ids of an earlier start, which made fewer than one per microsecond.
std::uint64_t first_id() { return static_cast<std::uint64_t>(tai_ns(tai_now()) / 1000); }

nlohmann::json leap_seconds_json() {
  nlohmann::json offsets = nlohmann::json::array();
  for (const LeapSecond& leap : leap_seconds()) {
    offsets.push_back(
        {{"start_tai_ns", tai_ns(leap.start)}, {"tai_minus_utc_s", leap.tai_minus_utc_s}});
  }
  return offsets;
}

nlohmann::json go_json(const GoNoGo& go) {
  nlohmann::json against = nlohmann::json::array();
  for (const Objection& objection : go.against) {
    against.push_back({{"code", objection.code}, {"text", objection.text}});
  }
  nlohmann::json accepted = nlohmann::json::array();
  for (const AcceptedAlert& alert : go.accepted) {
    accepted.push_back({{"key", alert.key},
                        {"by", alert.accepted.by},
                        {"t_tai_ns", tai_ns(alert.accepted.t)},
                        {"utc", format_utc(alert.accepted.t)},
                        {"text", alert.text}});
  }
  return {{"is_go", go.against.empty()},
          {"against", std::move(against)},
          {"accepted", std::move(accepted)}};
}

}  // namespace

ConsoleFeed::ConsoleFeed(const std::vector<Mission>& missions, nlohmann::json service)
    : service_(std::move(service)), ring_{first_id()} {  // Braces would make service_ an array.
  for (const Mission& mission : missions) {
    kinds_.emplace(mission.spacecraft_id, mission.kind());
    shown_.emplace(mission.spacecraft_id, mission);
  }
}

void ConsoleFeed::put(const std::string& spacecraft, const std::string& run_id,
                      const Product& product) {
  const std::lock_guard lock{mutex_};
  if (const auto* const alert = std::get_if<Alert>(&product)) {
    ring_.append("alert", put_alert(spacecraft, run_id, *alert));
    has_news_ = true;
    return;
  }
  const auto shown = shown_.find(spacecraft);
  if (shown == shown_.end()) {
    return;
  }
  shown->second.switch_to(run_id);
  std::visit(
      [&]<class Kind>(const Kind& is) {
        if constexpr (!kEvent<Kind>.empty()) {
          has_news_ = has_news_ || std::is_same_v<Kind, SpinFix>;
          nlohmann::json row = shown->second.show(is);
          row["spacecraft"] = spacecraft;
          ring_.append(kEvent<Kind>, row);
        } else if constexpr (std::is_same_v<Kind, ReconstructionProduct>) {
          shown->second.show(is);
        }
      },
      product);
}

void ConsoleFeed::put(const std::string& spacecraft, const std::string& run_id,
                      const std::vector<Product>& results) {
  {
    const std::lock_guard lock{mutex_};
    shown_.at(spacecraft).switch_to(run_id);
  }
  for (const Product& result : results) {
    put(spacecraft, run_id, result);
  }
}

void ConsoleFeed::put_details(const ArchiveBatch& stored) {
  const std::lock_guard lock{mutex_};
  for (const RejectedInput& rejected : stored.rejected) {
    samples_rejected_ += rejected.samples;
  }
  if (const auto shown = shown_.find(stored.spacecraft_id); shown != shown_.end()) {
    shown->second.take_details(stored);
  }
}

void ConsoleFeed::put(const Health& health) {
  const std::lock_guard lock{mutex_};
  service_.update(nlohmann::json{{"status", health.status},
                                 {"message", health.message},
                                 {"samples_received", health.samples_received},
                                 {"samples_committed", health.samples_committed},
                                 {"samples_rejected", samples_rejected_},
                                 {"gaps", health.gaps},
                                 {"duplicates", health.duplicates},
                                 {"queue_depth", health.queue_depth},
                                 {"commit_p99_ms", health.commit_p99_ms}});
  trouble_ = health.works ? "" : health.status;
  last_health_ = std::chrono::steady_clock::now();
  for (const SpacecraftHealth& one : health.spacecraft) {
    if (const auto shown = shown_.find(one.spacecraft); shown != shown_.end()) {
      shown->second.show(one);
    }
  }
  ring_.append("health", service_);
}

void ConsoleFeed::put(const StoredAlert& stored) {
  const std::lock_guard lock{mutex_};
  put_alert(stored.spacecraft, stored.run_id, stored.alert);
}

nlohmann::json ConsoleFeed::put_alert(const std::string& spacecraft, const std::string& run_id,
                                      const Alert& alert) {
  nlohmann::json row = alert_json(spacecraft, run_id, alert);
  row["spacecraft"] = spacecraft;
  const std::pair place{spacecraft, alert.key};
  if (alert.state == AlertState::Cleared) {
    alerts_.erase(place);
  } else {
    alerts_.insert_or_assign(place, OpenAlert{alert, row});
  }
  return row;
}

void ConsoleFeed::put(const std::string& spacecraft, const std::string& run_id,
                      const PassVerdict& verdict) {
  const std::lock_guard lock{mutex_};
  if (ShownSpacecraft& shown = shown_.at(spacecraft); shown.run_id() == run_id) {
    has_news_ = shown.show(verdict) || has_news_;
  }
}

void ConsoleFeed::put(const std::string& spacecraft, const SpinTarget& target) {
  const std::lock_guard lock{mutex_};
  shown_.at(spacecraft).show(target);
}

void ConsoleFeed::tell_state() {
  const std::lock_guard lock{mutex_};
  ring_.append("state", state_now());
  has_news_ = false;
}

bool ConsoleFeed::has_news() const {
  const std::lock_guard lock{mutex_};
  return has_news_;
}

void ConsoleFeed::tell_pulses() {
  const std::lock_guard lock{mutex_};
  for (auto& [spacecraft, shown] : shown_) {
    if (nlohmann::json pulses = shown.take_pulses(); !pulses.empty()) {
      ring_.append("pulse", {{"spacecraft", spacecraft}, {"pulses", std::move(pulses)}});
    }
  }
}

void ConsoleFeed::note_latency(std::chrono::duration<double> latency) {
  const std::lock_guard lock{mutex_};
  latencies_.add(latency.count());
}

DurationHistogram ConsoleFeed::latencies() const {
  const std::lock_guard lock{mutex_};
  return latencies_;
}

nlohmann::json ConsoleFeed::state() {
  const std::lock_guard lock{mutex_};
  return state_now();
}

std::string ConsoleFeed::trouble() const {
  const std::lock_guard lock{mutex_};
  return trouble_now();
}

std::string ConsoleFeed::trouble_now() const {
  if (!last_health_) {
    return {};  // The service is still starting.
  }
  const auto silent = std::chrono::steady_clock::now() - *last_health_;
  return silent <= kNoHealthFor
             ? trouble_
             : fmt::format("no heartbeat of the service for {} s",
                           std::chrono::duration_cast<std::chrono::seconds>(silent).count());
}

std::optional<std::string> ConsoleFeed::run_of(const std::string& spacecraft) const {
  const std::lock_guard lock{mutex_};
  const auto shown = shown_.find(spacecraft);
  return shown == shown_.end() ? std::nullopt : std::optional{shown->second.run_id()};
}

std::optional<SpacecraftKind> ConsoleFeed::kind_of(const std::string& spacecraft) const {
  const auto kind = kinds_.find(spacecraft);
  return kind == kinds_.end() ? std::nullopt : std::optional{kind->second};
}

EventRing::News ConsoleFeed::after(std::uint64_t id) const {
  const std::lock_guard lock{mutex_};
  return ring_.after(id);
}

bool ConsoleFeed::holds_all_after(std::uint64_t id) const {
  const std::lock_guard lock{mutex_};
  return ring_.holds_all_after(id);
}

std::uint64_t ConsoleFeed::nearest(std::uint64_t id) const {
  const std::lock_guard lock{mutex_};
  return ring_.nearest(id);
}

nlohmann::json ConsoleFeed::state_now() {
  const TaiTime now = tai_now();
  nlohmann::json state{{"t_tai_ns", tai_ns(now)},
                       {"utc", format_utc(now)},
                       {"leap_seconds", leap_seconds_json()},
                       {"service", service_},
                       {"alerts", nlohmann::json::array()},
                       {"spacecraft", nlohmann::json::object()}};
  std::map<std::string, std::vector<Alert>> alerts_of;
  for (const auto& [place, open] : alerts_) {
    state["alerts"].push_back(open.row);
    alerts_of[place.first].push_back(open.alert);
  }
  for (auto& [spacecraft, shown] : shown_) {
    nlohmann::json one = shown.state();
    Standing standing = shown.standing();
    standing.alerts = std::move(alerts_of[spacecraft]);
    one["go"] = go_json(go_no_go(standing, trouble_now(), shown.limits()));
    state["spacecraft"][spacecraft] = std::move(one);
  }
  return state;
}

}  // namespace spindrift
