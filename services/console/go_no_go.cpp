#include "services/console/go_no_go.h"

#include <fmt/format.h>

#include <optional>
#include <string_view>
#include <utility>

namespace spindrift {
namespace {

void add(nlohmann::json& against, std::string_view code, std::string text) {
  against.push_back({{"code", code}, {"text", std::move(text)}});
}

std::optional<double> number_of(const nlohmann::json& shown, const char* name) {
  const auto found = shown.find(name);
  return found != shown.end() && found->is_number() ? std::optional{found->get<double>()}
                                                    : std::nullopt;
}

void see_link(const nlohmann::json& shown, nlohmann::json& against) {
  const auto state = shown.value("state", "waiting");
  if (state == "waiting") {
    add(against, "link", "no telemetry has come yet");
  } else if (state != "live") {
    const auto age_s = number_of(shown, "data_age_s");
    add(against, "link", age_s ? fmt::format("no telemetry for {:.0f} s", *age_s) : "no telemetry");
  }
}

void see_answer(const nlohmann::json& shown, nlohmann::json& against) {
  const auto quality = shown.value("quality", "");
  if (quality.empty() || !number_of(shown, "sigma_deg")) {
    add(against, "quality", "no answer yet");
    return;
  }
  const auto said = shown.value("against", "");
  const bool has_quality = quality == "OK" || said.starts_with(quality);
  if (quality != "OK" || !said.empty()) {
    add(against, "quality", has_quality ? said : fmt::format("{}: {}", quality, said));
  }
}

void see_axis(const nlohmann::json& shown, const AlertLimits& limits, nlohmann::json& against) {
  const auto sigma_deg = number_of(shown, "sigma_deg");
  if (!sigma_deg) {
    return;  // There is no answer.
  }
  if (*sigma_deg > limits.sigma_deg) {
    add(against, "sigma",
        fmt::format("sigma {:.3g} deg, limit {:g}", *sigma_deg, limits.sigma_deg));
  }
  const auto off_deg = number_of(shown, "to_target_deg");
  const double limit_deg = limits.off_target_deg + limits.off_target_sigmas * *sigma_deg;
  if (off_deg && *off_deg > limit_deg) {
    add(against, "target",
        fmt::format("{:.3g} deg off the target, limit {:.3g}", *off_deg, limit_deg));
  }
}

void see_alerts(const nlohmann::json& alerts, nlohmann::json& against) {
  for (const nlohmann::json& alert : alerts) {
    if (alert["severity"] != "info") {
      add(against, "alert",
          fmt::format("{} {}, {}", alert["severity"].get<std::string>(),
                      alert["key"].get<std::string>(), alert["state"].get<std::string>()));
    }
  }
}

}  // namespace

nlohmann::json go_no_go(const nlohmann::json& shown, const nlohmann::json& alerts,
                        const std::string& trouble, const AlertLimits& limits) {
  nlohmann::json against = nlohmann::json::array();
  if (!trouble.empty()) {
    add(against, "service", trouble);
  }
  see_link(shown, against);
  see_answer(shown, against);
  if (shown.value("kind", "") == "spin") {
    see_axis(shown, limits, against);
  }
  see_alerts(alerts, against);
  const bool is_go = against.empty();
  return {{"is_go", is_go}, {"against", std::move(against)}};
}

}  // namespace spindrift
