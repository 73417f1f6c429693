#include "services/mission/mission_alerts.h"

#include <fmt/format.h>

#include <string>

#include "pipelines/frames/celestial.h"
#include "pipelines/time/utc.h"
#include "services/base/degrees.h"
#include "services/mission/values.h"

namespace spindrift {
namespace {

ShareLimit share_limit(const TomlValues& values, const std::string& table) {
  return {.percent = number(values, table + ".percent"),
          .revolutions = static_cast<int>(number(values, table + ".revolutions"))};
}

}  // namespace

AlertLimits alert_limits(const TomlValues& values) {
  return {
      .link_silent_s = number(values, "alerts.link.silent.seconds"),
      .link_late_s = number(values, "alerts.link.late.seconds"),
      .gap_samples = number(values, "alerts.link.gap.samples"),
      .rejected_percent = number(values, "alerts.link.rejected.percent"),
      .repeated_samples = number(values, "alerts.link.repeated.samples"),
      .contradicted_samples = number(values, "alerts.link.contradiction.samples"),
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
      .diverged_percent = number(values, "alerts.attitude.diverged.percent"),
      .diverged_s = number(values, "alerts.attitude.diverged.seconds"),
      .contradicts_sigmas = number(values, "alerts.sensor.contradicts.sigmas"),
      .launcher_percent = number(values, "alerts.reconstruction.launcher.percent"),
      .departure_sigmas = number(values, "alerts.model.departure.sigmas"),
      .backlog_s = number(values, "alerts.archive.backlog.seconds"),
      .disk_gib = number(values, "alerts.archive.disk.gib"),
      .clock_jump_s = number(values, "alerts.clock.jump.seconds")};
}

std::optional<Contact> planned_contact(TomlDocument& document) {
  const auto aos = value_if<std::string>(document.values, "contact.aos_utc");
  const auto los = value_if<std::string>(document.values, "contact.los_utc");
  if (!aos || !los) {
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
