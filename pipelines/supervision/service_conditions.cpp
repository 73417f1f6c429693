#include "pipelines/supervision/service_conditions.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "pipelines/time/time_span.h"

namespace spindrift {
namespace {

// A burst that a front-end sends again is late only for a moment.
constexpr Holding kNotForAMoment{.raise_s = 2.0, .clear_s = 2.0};
constexpr double kDay_h = 24.0;

}  // namespace

ServiceConditions::Source::Source(const std::string& name)
    : gap{AlertCode::LinkGap, "samples", {}, name},
      restarted{AlertCode::LinkRestarted, "sessions", {}, name},
      again{AlertCode::LinkRepeated, "samples", {}, name} {}

ServiceConditions::ServiceConditions(const AlertLimits& limits, std::optional<Contact> contact)
    : limits_{limits},
      contact_{contact},
      silent_{AlertCode::LinkSilent, "s"},
      late_{AlertCode::LinkLate, "s", kNotForAMoment},
      ahead_{AlertCode::LinkAhead, "s", kNotForAMoment},
      rejected_{AlertCode::LinkRejected, "%"},
      twice_{AlertCode::ServiceTwice, "services"},
      undelivered_{AlertCode::AlertsUndelivered, "s"},
      backlog_{AlertCode::ArchiveBacklog, "s"},
      write_{AlertCode::ArchiveWrite, "failures"},
      disk_{AlertCode::ArchiveDisk, "GiB"},
      log_{AlertCode::ArchiveLog, "MiB"},
      disagree_{AlertCode::ClockDisagree, "s", kNotForAMoment},
      clock_{AlertCode::ClockJump, "s", {.raise_s = 0.0, .clear_s = 60.0}} {}

ConditionChanges ServiceConditions::evaluate(const ServiceState& state) {
  ConditionChanges changes;
  see_silence(state, changes);
  see_link(state, changes);
  see_archive(state, changes);
  see_data(state, changes);
  auto twice = twice_.update(state.t, state.other_service.has_value());
  if (twice) {
    twice->who = state.other_service.value_or("");
  }
  add(std::move(twice), changes);
  add(undelivered_.update(state.t, {.value = state.undelivered_s, .limit = limits_.undelivered_s}),
      changes);
  return changes;
}

/// No telemetry is expected outside a planned contact.
void ServiceConditions::see_silence(const ServiceState& state, ConditionChanges& changes) {
  if (!state.silent_s) {
    return;
  }
  double silent_s = *state.silent_s;
  if (contact_) {
    const bool is_over = state.pass_t > contact_->to;
    silent_s = is_over ? 0.0 : std::clamp(elapsed_s(contact_->from, state.pass_t), 0.0, silent_s);
  }
  auto change = silent_.update(state.t, {.value = silent_s, .limit = limits_.link_silent_s});
  if (change && contact_) {
    change->severity = AlertSeverity::Critical;
  }
  add(std::move(change), changes);
}

void ServiceConditions::see_link(const ServiceState& state, ConditionChanges& changes) {
  if (state.late_s) {
    add(late_.update(state.t, {.value = *state.late_s, .limit = limits_.link_late_s}), changes);
    add(ahead_.update(state.t, {.value = -*state.late_s, .limit = limits_.link_late_s}), changes);
    add(disagree_.update(state.t,
                         {.value = std::abs(*state.late_s), .limit = limits_.host_within_s}),
        changes);
  }
  const double received = received_count_.rise_at(state.t, state.received);
  const double rejected = rejected_count_.rise_at(state.t, state.rejected);
  if (received > 0.0) {
    add(rejected_.update(state.t,
                         {.value = 100.0 * rejected / received, .limit = limits_.rejected_percent}),
        changes);
  }
  for (const auto& [name, record] : state.sources) {
    Source& source = sources_.try_emplace(name, name).first->second;
    add(source.gap.update(state.t, {.value = source.missing.rise_at(state.t, record.missing),
                                    .limit = limits_.gap_samples}),
        changes);
    add(source.restarted.update(
            state.t, {.value = source.restarts.rise_at(state.t, record.restarts), .limit = 1.0}),
        changes);
    add(source.again.update(state.t, {.value = source.repeated.rise_at(state.t, record.repeated),
                                      .limit = limits_.repeated_samples}),
        changes);
  }
}

void ServiceConditions::see_archive(const ServiceState& state, ConditionChanges& changes) {
  add(backlog_.update(state.t, {.value = state.backlog_s, .limit = limits_.backlog_s}), changes);
  add(write_.update(state.t, state.write_failed), changes);
  add(log_.update(state.t, {.value = state.log_mib, .limit = limits_.log_mib}), changes);
  if (state.free_gib) {
    add(disk_.see_least(state.t, {.value = *state.free_gib, .limit = limits_.disk_gib}), changes);
  }
}

void ServiceConditions::see_data(const ServiceState& state, ConditionChanges& changes) {
  add(clock_.update(state.t,
                    {.value = std::abs(state.clock_step_s), .limit = limits_.clock_jump_s}),
      changes);
  for (const auto& [what, end] : state.data_ends) {
    ConditionWatch& watch =
        outdated_.try_emplace(what, ConditionWatch{AlertCode::DataOutdated, "h", {}, what})
            .first->second;
    auto change = watch.see_least(
        state.t, {.value = elapsed_s(state.pass_t, end.until) / 3600.0, .limit = kDay_h});
    if (change) {
      change->severity = end.severity;
    }
    add(std::move(change), changes);
  }
}

}  // namespace spindrift
