#include "services/serving/service_watch.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#include <utility>

#include "pipelines/time/time_span.h"
#include "pipelines/time/utc.h"
#include "services/alerts/webhook.h"
#include "services/base/leap_tables.h"
#include "services/base/wall_clock.h"

namespace spindrift {
namespace {

constexpr double kBytesPerGib = 1024.0 * 1024.0 * 1024.0;

/// A table that has merely expired says nothing against UTC: leap seconds are announced half a year
/// before, and none may have been.
std::optional<DataEnd> leap_seconds_end() {
  const LeapFacts facts = leap_facts(tai_now());
  const auto lacking = lacking_from(facts);
  const std::chrono::sys_days until = lacking.value_or(
      facts.machine ? std::max(facts.machine->complete_until, facts.erfa.complete_until)
                    : facts.erfa.complete_until);
  const auto t = parse_utc(fmt::format("{:%Y-%m-%dT%H:%M:%S}Z",
                                       fmt::gmtime(std::chrono::system_clock::to_time_t(until))));
  return t ? std::optional{DataEnd{
                 .until = *t, .severity = lacking ? AlertSeverity::Warning : AlertSeverity::Info}}
           : std::nullopt;
}

std::optional<double> free_gib(const std::filesystem::path& db) {
  std::error_code unknown;
  const auto space = std::filesystem::space(db.has_parent_path() ? db.parent_path() : ".", unknown);
  return unknown ? std::nullopt
                 : std::optional{static_cast<double>(space.available) / kBytesPerGib};
}

}  // namespace

ServiceWatch::ServiceWatch(const ServiceParts& parts, const Heard& heard)
    : parts_{parts}, heard_{heard} {
  const auto leap_seconds = leap_seconds_end();
  for (const Mission& mission : parts.missions) {
    auto& ends = data_ends_[mission.spacecraft_id];
    if (leap_seconds) {
      ends.emplace("leap_seconds", *leap_seconds);
    }
    if (mission.orbit && mission.orbit->ephemeris() != nullptr) {
      ends.emplace("orbit", DataEnd{.until = mission.orbit->ephemeris()->usable_to()});
    }
    if (const auto end = field_end(mission)) {
      ends.emplace("field_coefficients", DataEnd{.until = *end});
    }
  }
}

Expected<ServiceWatch::States> ServiceWatch::look(
    const TelemetrySubscriberStatus& status, const std::map<std::string, std::uint64_t>& gaps) {
  const Instant now = std::chrono::steady_clock::now();
  note_time(now);
  const auto others =
      parts_.told.clocks.look().and_then([&] { return parts_.told.others.look(now); });
  if (!others) {
    return Unexpected{others.error()};
  }
  const ServiceState of_service = state_of_service(now);
  States states;
  for (const SpacecraftHealth& link : heard_.links.report(now)) {
    if (!link.data_age_s) {
      continue;
    }
    ServiceState state = of_service;
    note_link(link, heard_.links.silent_s(link.spacecraft, now), state);
    if (const auto other = others->find(link.spacecraft); other != others->end()) {
      state.other_service = other->second;
    }
    state.sources = heard_.sessions.report(link.spacecraft, gaps);
    const SpacecraftCounts& counts = status.by_spacecraft.at(link.spacecraft);
    state.received = static_cast<std::int64_t>(counts.received);
    state.rejected = static_cast<std::int64_t>(counts.rejected);
    states.emplace(link.spacecraft, std::move(state));
  }
  return states;
}

/// Advances the time of the watch. When the wall clock is set back, the time goes on by the steady
/// clock, because times of earlier reports must not be repeated.
void ServiceWatch::note_time(Instant now) {
  const TaiTime wall = tai_now();
  if (last_) {
    const auto elapsed = now - *last_;
    clock_step_s_ = elapsed_s(later_by(wall_, elapsed), wall);
    t_ = std::max(wall, later_by(t_, elapsed));
  } else {
    t_ = wall;
  }
  wall_ = wall;
  last_ = now;
}

ServiceState ServiceWatch::state_of_service(Instant now) {
  const ArchiveStatistics archive = parts_.archive.statistics();
  const bool failed =
      archive.failure || archive.failures > std::exchange(failures_, archive.failures);
  return {.t = t_,
          .pass_t = t_,
          .silent_s = std::nullopt,
          .late_s = std::nullopt,
          .undelivered_s = parts_.webhook ? parts_.webhook->deliveries().failing_s(now) : 0.0,
          .backlog_s = backlog_.update(now, heard_.sessions.samples(), archive.samples_committed),
          .write_failed = failed,
          .free_gib = free_gib(parts_.db),
          .log_mib = archive.log_mib,
          .clock_step_s = clock_step_s_};
}

/// Fills in the state of a link. While the archive does not store, or makes batches wait in the
/// queue, the link counts as silent no longer than it is live. The telemetry of a rehearsal follows
/// the clock that the rehearsal announces, and that of another replay its own, for which nobody
/// updates auxiliary data.
void ServiceWatch::note_link(const SpacecraftHealth& link, std::optional<double> silent_s,
                             ServiceState& state) const {
  const bool waits = state.write_failed || parts_.taken.size() > 0;
  if (!waits || link.link == LinkState::Live) {
    state.silent_s = silent_s;
  }
  const TaiTime heard = later_by_s(*link.last_sample, *link.data_age_s);
  const auto rehearsal = parts_.told.clocks.offset(link.spacecraft);
  if (rehearsal || parts_.mode == RunMode::Live) {
    const auto offset = rehearsal.value_or(std::chrono::nanoseconds{0});
    state.late_s = elapsed_s(heard, later_by(wall_, -offset));
    state.pass_t = later_by(t_, -offset);
    state.data_ends = data_ends_.at(link.spacecraft);
  } else {
    state.pass_t = heard;
  }
}

}  // namespace spindrift
