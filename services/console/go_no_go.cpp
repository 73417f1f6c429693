#include "services/console/go_no_go.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>

#include "pipelines/core/shown.h"
#include "pipelines/time/utc.h"
#include "services/base/alert_words.h"

namespace spindrift {
namespace {

using Objections = std::vector<Objection>;

bool has_answer(const PassVerdict& verdict) { return verdict.quality && verdict.sigma_deg; }

void see_link(const Standing& standing, Objections& against) {
  if (standing.link == LinkState::Waiting) {
    against.push_back({"link", "no telemetry has come yet"});
  } else if (standing.link != LinkState::Live) {
    against.push_back({"link", standing.data_age_s
                                   ? fmt::format("no telemetry for {:.0f} s", *standing.data_age_s)
                                   : "no telemetry"});
  }
}

void see_answer(const PassVerdict& verdict, Objections& against) {
  if (!has_answer(verdict)) {
    against.push_back({"quality", "no answer yet"});
    return;
  }
  const auto name = name_of(*verdict.quality);
  std::string text = verdict.against;
  if (*verdict.quality != Quality::Ok && !text.starts_with(name)) {
    text = text.empty() ? std::string{name} : fmt::format("{}: {}", name, text);
  }
  if (!text.empty()) {
    against.push_back({"quality", std::move(text)});
  }
}

/// An unknown key is held to bear on the answer.
bool is_accepted(const Alert& alert) {
  const auto code = code_of(alert.key);
  return alert.state == AlertState::Acknowledged && alert.accepted &&
         alert.severity == AlertSeverity::Warning && code && !bears_on_answer(*code);
}

/// Returns whether an operator has accepted that the condition holds.
bool is_accepted(const std::vector<Alert>& alerts, AlertCode code) {
  return std::any_of(alerts.begin(), alerts.end(), [code](const Alert& alert) {
    return code_of(alert.key) == code && is_accepted(alert);
  });
}

void see_axis(const Standing& standing, const AlertLimits& limits, Objections& against) {
  if (!has_answer(standing.verdict)) {
    return;
  }
  const double sigma_deg = *standing.verdict.sigma_deg;
  if (sigma_deg > limits.sigma_deg) {
    against.push_back(
        {"sigma", fmt::format("sigma {:.3g} deg, limit {:g}", sigma_deg, limits.sigma_deg)});
  }
  const double limit_deg = limits.off_target_deg + limits.off_target_sigmas * sigma_deg;
  if (standing.to_target_deg && *standing.to_target_deg > limit_deg &&
      !is_accepted(standing.alerts, AlertCode::SpinOffTarget)) {
    against.push_back({"target", fmt::format("{:.3g} deg off the target, limit {:.3g}",
                                             *standing.to_target_deg, limit_deg)});
  }
}

AcceptedAlert accepted_of(const Alert& alert) {
  constexpr std::size_t kMinutes = 11;  // Of "2026-11-20T03:12:00.000Z".
  return {
      .key = alert.key,
      .accepted = *alert.accepted,
      .text = fmt::format("{}, accepted by {} {}", words_of(alert.key), shown(alert.accepted->by),
                          format_utc(alert.accepted->t).substr(kMinutes, 5))};
}

void see_alerts(const std::vector<Alert>& alerts, GoNoGo& go) {
  for (const Alert& alert : alerts) {
    if (is_accepted(alert)) {
      go.accepted.push_back(accepted_of(alert));
    } else if (alert.severity != AlertSeverity::Info) {
      go.against.push_back({"alert", fmt::format("{} {}, {}", name_of(alert.severity), alert.key,
                                                 name_of(alert.state))});
    }
  }
}

}  // namespace

GoNoGo go_no_go(const Standing& standing, const std::string& trouble, const AlertLimits& limits) {
  GoNoGo go;
  Objections& against = go.against;
  if (trouble.empty()) {
    see_link(standing, against);
  } else {
    against.push_back({"service", trouble});  // What comes is not known then.
  }
  see_answer(standing.verdict, against);
  if (standing.kind == SpacecraftKind::Spin) {
    see_axis(standing, limits, against);
  }
  see_alerts(standing.alerts, go);
  return go;
}

}  // namespace spindrift
