#include "services/mission/mission_alerts.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <string>
#include <string_view>

#include "pipelines/frames/celestial.h"
#include "pipelines/time/utc.h"
#include "services/base/degrees.h"
#include "services/mission/values.h"

namespace spindrift {
namespace {

constexpr std::string_view kAlerts = "alerts.";
constexpr std::string_view kHostWithin = "time.host_within_s";

ShareLimit share_limit(const TomlValues& values, const std::string& table) {
  return {.percent = number(values, table + ".percent"),
          .revolutions = static_cast<int>(number(values, table + ".revolutions"))};
}

std::array<double, kAlertCodes> hold_offs_s(const TomlValues& values) {
  std::array<double, kAlertCodes> all{};
  for (int i = 0; i < kAlertCodes; ++i) {
    all.at(static_cast<std::size_t>(i)) =
        number(values, limit_path(name_of(static_cast<AlertCode>(i)), "hold_off_s"));
  }
  return all;
}

void refuse_phases(TomlDocument& document) {
  for (const std::string_view phase : {kBeforeContact, kAfterContact}) {
    const std::string table = fmt::format("{}{}", kAlerts, phase);
    const auto limit = document.values.lower_bound(table + ".");
    if (limit != document.values.end() && limit->first.starts_with(table + ".")) {
      add_problem(document, table,
                  fmt::format("{}: needs [contact], whose times it refers to", table));
    }
  }
}

}  // namespace

void put_phase(std::string_view phase, TomlValues& values) {
  const std::string table = fmt::format("{}{}.", kAlerts, phase);
  for (auto limit = values.lower_bound(table);
       limit != values.end() && limit->first.starts_with(table); ++limit) {
    values.insert_or_assign(std::string{kAlerts} + limit->first.substr(table.size()),
                            limit->second);
  }
}

std::string limit_path(std::string_view key, std::string_view name) {
  return fmt::format("{}{}.{}", kAlerts, key, name);
}

TomlValues alert_values(const TomlValues& values) {
  TomlValues all;
  std::copy_if(values.begin(), values.end(), std::inserter(all, all.end()), [](const auto& value) {
    return value.first.starts_with(kAlerts) || value.first == kHostWithin;
  });
  return all;
}

AlertLimits alert_limits(const TomlValues& values) {
  return {
      .link_silent_s = number(values, "alerts.link.silent.seconds"),
      .link_late_s = number(values, "alerts.link.late.seconds"),
      .gap_samples = number(values, "alerts.link.gap.samples"),
      .rejected_percent = number(values, "alerts.link.rejected.percent"),
      .repeated_samples = number(values, "alerts.link.repeated.samples"),
      .contradicted_samples = number(values, "alerts.link.contradiction.samples"),
      .undelivered_s = number(values, "alerts.alerts.undelivered.seconds"),
      .silent_s = number(values, "alerts.channel.silent.seconds"),
      .silent_revolutions = static_cast<int>(number(values, "alerts.channel.silent.revolutions")),
      .period = share_limit(values, "alerts.spin.period"),
      .rejection = share_limit(values, "alerts.spin.rejection"),
      .ambiguous_s = number(values, "alerts.spin.ambiguous.seconds"),
      .doubtful_s = number(values, "alerts.spin.doubtful.seconds"),
      .sigma_deg = number(values, "alerts.spin.sigma.deg"),
      .sigma_after_s = number(values, "alerts.spin.sigma.after_s"),
      .disagree_sigmas = number(values, "alerts.spin.disagree.sigmas"),
      .off_target_deg = number(values, "alerts.spin.off_target.deg"),
      .off_target_sigmas = number(values, "alerts.spin.off_target.sigmas"),
      .nutation_deg = number(values, "alerts.spin.nutation.deg"),
      .spin_no_answer_s = number(values, "alerts.spin.no_answer.seconds"),
      .attitude_doubtful_s = number(values, "alerts.attitude.doubtful.seconds"),
      .attitude_no_answer_s = number(values, "alerts.attitude.no_answer.seconds"),
      .diverged_percent = number(values, "alerts.attitude.diverged.percent"),
      .diverged_s = number(values, "alerts.attitude.diverged.seconds"),
      .contradicts_sigmas = number(values, "alerts.sensor.contradicts.sigmas"),
      .stuck_s = number(values, "alerts.sensor.stuck.seconds"),
      .launcher_percent = number(values, "alerts.reconstruction.launcher.percent"),
      .departure_sigmas = number(values, "alerts.model.departure.sigmas"),
      .backlog_s = number(values, "alerts.archive.backlog.seconds"),
      .disk_gib = number(values, "alerts.archive.disk.gib"),
      .log_mib = number(values, "alerts.archive.log.mib"),
      .host_within_s = number(values, kHostWithin),
      .clock_jump_s = number(values, "alerts.clock.jump.seconds"),
      .hold_off_s = hold_offs_s(values)};
}

std::optional<Contact> planned_contact(TomlDocument& document) {
  const auto aos = value_if<std::string>(document.values, "contact.aos_utc");
  const auto los = value_if<std::string>(document.values, "contact.los_utc");
  if (!aos || !los) {
    refuse_phases(document);
    return std::nullopt;
  }
  const Contact contact{.from = parse_utc(*aos).value(), .to = parse_utc(*los).value()};
  if (contact.to <= contact.from) {
    add_problem(
        document, "contact.los_utc",
        fmt::format(R"(contact.los_utc = "{}": must be later than aos_utc = "{}")", *los, *aos));
  }
  return contact;
}

std::optional<SpinTarget> spin_target(const TomlValues& values) {
  if (!values.contains("spin.target.ra_deg")) {
    return std::nullopt;
  }
  SpinTarget target{.axis_icrf =
                        direction_icrf({.ra_rad = radians(values, "spin.target.ra_deg"),
                                        .dec_rad = radians(values, "spin.target.dec_deg")})};
  const auto rpm = value_if<double>(values, "spin.target.rpm");
  const auto tolerance_rpm = value_if<double>(values, "spin.target.tolerance_rpm");
  if (rpm && tolerance_rpm) {
    target.rate = {.rad_s = *rpm / kRpmPerRad_s, .tolerance_rad_s = *tolerance_rpm / kRpmPerRad_s};
  }
  return target;
}

}  // namespace spindrift
