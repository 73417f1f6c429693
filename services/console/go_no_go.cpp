#include "services/console/go_no_go.h"

#include <fmt/format.h>

#include <string>
#include <utility>

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
  if (standing.to_target_deg && *standing.to_target_deg > limit_deg) {
    against.push_back({"target", fmt::format("{:.3g} deg off the target, limit {:.3g}",
                                             *standing.to_target_deg, limit_deg)});
  }
}

void see_alerts(const std::vector<Alert>& alerts, Objections& against) {
  for (const Alert& alert : alerts) {
    if (alert.severity != AlertSeverity::Info) {
      against.push_back({"alert", fmt::format("{} {}, {}", name_of(alert.severity), alert.key,
                                              name_of(alert.state))});
    }
  }
}

}  // namespace

std::vector<Objection> go_no_go(const Standing& standing, const std::string& trouble,
                                const AlertLimits& limits) {
  Objections against;
  if (!trouble.empty()) {
    against.push_back({"service", trouble});
  }
  see_link(standing, against);
  see_answer(standing.verdict, against);
  if (standing.kind == SpacecraftKind::Spin) {
    see_axis(standing, limits, against);
  }
  see_alerts(standing.alerts, against);
  return against;
}

}  // namespace spindrift
