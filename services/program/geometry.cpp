#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "pipelines/core/shown.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/spin/types/spin_rate.h"
#include "pipelines/time/time_span.h"
#include "services/base/degrees.h"
#include "services/base/json_line.h"
#include "services/base/warning.h"
#include "services/mission/mission.h"
#include "services/program/commands.h"
#include "services/program/orbit_notice.h"
#include "services/program/outcome.h"
#include "services/program/utc_option.h"
#include "services/reports/planned_pass.h"
#include "services/reports/scale.h"
#include "services/simulation/output_file.h"

namespace spindrift {
namespace {

constexpr double kUsualRate_rpm = 60.0;
constexpr double kRows = 60.0;
constexpr double kMostRows = 10'000.0;
constexpr double kLongest_s = 7.0 * 86'400.0;
// This many steps give smooth curves.
constexpr double kPlotSteps = 480.0;

/// Collects the problems, one per line.
struct Refusals {
  std::string text;
  void add(const std::string& problem) { text += (text.empty() ? "" : "\n") + problem; }
};

std::optional<TaiTime> utc_of(std::string_view option, const std::string& text,
                              Refusals& refusals) {
  const auto t = utc_option(option, text);
  if (!t) {
    refusals.add(t.error().message);
    return std::nullopt;
  }
  return *t;
}

/// Parses the whole text as a number.
std::optional<double> number_of(std::string_view text) {
  double number = 0.0;
  const auto* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, number);
  return error == std::errc{} && rest == end ? std::optional{number} : std::nullopt;
}

/// The range checks are written so that NaN fails.
Eigen::Vector3d axis_of(const std::string& text, Refusals& refusals) {
  const std::size_t comma = std::min(text.find(','), text.size());
  const auto ra_deg = number_of(std::string_view{text}.substr(0, comma));
  const auto dec_deg = number_of(std::string_view{text}.substr(std::min(comma + 1, text.size())));
  if (!ra_deg || !dec_deg) {
    refusals.add(fmt::format("--attitude {}: must read RA,DEC in deg, as 100.5,-55", text));
    return Eigen::Vector3d::UnitZ();
  }
  if (!(std::abs(*ra_deg) <= 360.0)) {
    refusals.add(fmt::format("--attitude {}: RA must lie in [-360, 360] deg", text));
  }
  if (!(std::abs(*dec_deg) <= 90.0)) {
    refusals.add(fmt::format("--attitude {}: DEC must lie in [-90, 90] deg", text));
  }
  return direction_icrf({.ra_rad = *ra_deg / kDegPerRad, .dec_rad = *dec_deg / kDegPerRad});
}

void check_span(const GeometryOptions& options, double span_s, Refusals& refusals) {
  if (!(span_s > 0.0)) {
    refusals.add(fmt::format("--from {} must lie before --to {}", options.from, options.to));
  } else if (span_s > kLongest_s) {
    refusals.add(fmt::format("--from {} --to {}: {:.1f} days; at most {:.0f}", options.from,
                             options.to, span_s / 86'400.0, kLongest_s / 86'400.0));
  }
}

void check_step(double step_s, double span_s, Refusals& refusals) {
  if (!(step_s > 0.0 && std::isfinite(step_s))) {
    refusals.add(fmt::format("--step {}: must be above 0 s", step_s));
  } else if (span_s / step_s > kMostRows) {
    refusals.add(fmt::format("--step {}: makes {:.0f} rows; at most {:.0f}", step_s,
                             span_s / step_s, kMostRows));
  }
}

void check_rate(double rate_rpm, Refusals& refusals) {
  if (!(rate_rpm >= kSlowestSpin_rpm && rate_rpm <= kFastestSpin_rpm)) {
    refusals.add(fmt::format("--rpm {}: must lie in [{}, {}]", rate_rpm, kSlowestSpin_rpm,
                             kFastestSpin_rpm));
  }
}

Expected<PassRequest> request_of(const GeometryOptions& options) {
  Refusals refusals;
  const auto from = utc_of("--from", options.from, refusals);
  const auto to = utc_of("--to", options.to, refusals);
  const double rate_rpm = options.rate_rpm.value_or(kUsualRate_rpm);
  check_rate(rate_rpm, refusals);
  PassRequest request{.from = {},
                      .to = {},
                      .step_s = 0.0,
                      .axis_icrf = axis_of(options.attitude, refusals),
                      .rate_rad_s = rate_rpm / kRpmPerRad_s};
  if (from && to) {
    const double span_s = elapsed_s(*from, *to);
    request.from = *from;
    request.to = *to;
    request.step_s = options.step_s.value_or(plot::time_step_s(span_s / kRows));
    check_span(options, span_s, refusals);
    check_step(request.step_s, span_s, refusals);
  }
  if (!refusals.text.empty()) {
    return refused(refusals.text);
  }
  return request;
}

Expected<PlannedPass> planned(const GeometryOptions& options, const Mission& mission,
                              const PassRequest& request) {
  auto plan = plan_pass(*mission.spin(), *mission.orbit, request);
  if (!plan) {
    return refused(
        fmt::format("{}: orbit: {}", shown(options.mission.string()), plan.error().message));
  }
  return PlannedPass{.spacecraft_id = mission.spacecraft_id,
                     .config = *mission.spin(),
                     .request = request,
                     .rate_assumed = !options.rate_rpm,
                     .plan = std::move(*plan)};
}

Expected<void> write_plot(const GeometryOptions& options, const Mission& mission,
                          PassRequest request) {
  request.step_s = std::min(request.step_s, seconds_between(request.from, request.to) / kPlotSteps);
  return planned(options, mission, request).and_then([&](const PlannedPass& pass) {
    return write_file(options.plot, plot_of(pass));
  });
}

}  // namespace

Expected<void> geometry(const GeometryOptions& options) {
  const auto request = request_of(options);
  const auto mission = load_spinner(options.mission);
  if (!request || !mission) {
    return refused((request ? "" : request.error().message) + (request || mission ? "" : "\n") +
                   (mission ? "" : mission.error().message));
  }
  warn_of_orbit(options.mission, *mission);
  const auto pass = planned(options, *mission, *request);
  if (!pass) {
    return Unexpected{pass.error()};
  }
  if (!options.plot.empty()) {
    if (auto written = write_plot(options, *mission, *request); !written) {
      return written;
    }
  }
  if (options.json) {
    nlohmann::json json = to_json(*pass);
    json["plot"] =
        options.plot.empty() ? nlohmann::json(nullptr) : nlohmann::json(options.plot.string());
    fmt::print("{}", json_line(with_warnings(json)));
  } else {
    fmt::print("{}", to_text(*pass));
    if (!options.plot.empty()) {
      fmt::print("plot: {}\n", options.plot.string());
    }
  }
  return {};
}

}  // namespace spindrift
