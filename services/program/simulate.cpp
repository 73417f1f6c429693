#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <chrono>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "pipelines/core/shown.h"
#include "services/base/counted.h"
#include "services/base/json_key.h"
#include "services/base/json_line.h"
#include "services/base/progress_bar.h"
#include "services/base/wall_clock.h"
#include "services/base/warning.h"
#include "services/program/commands.h"
#include "services/program/outcome.h"
#include "services/program/telemetry_output.h"
#include "services/simulation/flight_plot.h"
#include "services/simulation/monte_carlo_text.h"
#include "services/simulation/output_file.h"
#include "services/simulation/pass_files.h"
#include "services/simulation/scenario.h"
#include "services/simulation/simulated_pass.h"

namespace spindrift {
namespace {

nlohmann::json counts_json(const std::vector<Counted>& counts) {
  nlohmann::json object = nlohmann::json::object();
  for (const auto& [plural, count] : counts) {
    object[json_key(plural)] = count;
  }
  return object;
}

/// Holds what is printed about the pass.
struct Output {
  nlohmann::json json = nlohmann::json::object();
  std::string text;
};

std::string since_text(const nlohmann::ordered_json& t_s) {
  return t_s.is_number() ? fmt::format("since {:.1f} s", t_s.get<double>()) : "never";
}

/// Describes the performance of an orientation's control.
std::string control_text(const nlohmann::ordered_json& truth) {
  return fmt::format(
      "  points {}, within 1 deg {}, {:.2g} deg off at the end\n"
      "  wheels at most {:.3g} N m s, {:.0f} rpm; phase margins {:.1f} deg\n",
      since_text(truth["pointing_s"]), since_text(truth["settled_s"]),
      truth["last_off_deg"].get<double>(), truth["wheel_nms_most"].get<double>(),
      truth["wheel_rpm_most"].get<double>(),
      fmt::join(truth["phase_margin_deg"].get<std::vector<double>>(), ", "));
}

std::string rescue_text(const nlohmann::ordered_json& truth) {
  return fmt::format("  lost {}, controlled {}, reached {}, {:.2g} deg off at the end\n",
                     since_text(truth["lost_s"]), since_text(truth["control_s"]),
                     since_text(truth["reached_s"]), truth["last_off_deg"].get<double>());
}

void report(const Scenario& scenario, const SimulatedPass& pass, Output output, bool json) {
  if (json) {
    output.json.update(counts_json(pass.made));
    output.json.update(
        {{"spacecraft", scenario.spacecraft_id}, {"faults", counts_json(pass.faults)}});
    if (pass.on_board) {
      output.json["on_board"] = pass.truth["on_board"];
    }
    fmt::print("{}", json_line(with_warnings(output.json)));
    return;
  }
  std::vector<std::string> made;
  for (const auto& [plural, count] : pass.made) {
    made.push_back(counted(count, plural));
  }
  fmt::print("{}: {}\n", scenario.spacecraft_id, fmt::join(made, ", "));
  for (const auto& [plural, count] : pass.faults) {
    fmt::print("  {}: {}\n", plural, count);
  }
  if (!pass.control.empty()) {
    fmt::print("{}", control_text(pass.truth));
  }
  if (std::holds_alternative<RescueScenario>(scenario.flight)) {
    fmt::print("{}", rescue_text(pass.truth));
  }
  if (pass.on_board) {
    fmt::print("{}", on_board_text(*scenario.carried_table, pass.truth["on_board"]));
  }
  fmt::print("{}", output.text);
}

/// Plots the flight and, if it has wheels, its control loops. @return The paths.
Expected<std::vector<std::filesystem::path>> write_plots(const std::filesystem::path& out,
                                                         const Scenario& scenario,
                                                         const SimulatedPass& pass) {
  std::vector<std::filesystem::path> paths = {out / "flight.svg"};
  auto written = write_file(paths.back(), flight_plot(scenario, pass));
  if (const auto* const flight = std::get_if<OrientationScenario>(&scenario.flight)) {
    paths.push_back(out / "loops.svg");
    written = written.and_then([&] { return channel_margins(flight->truth); })
                  .and_then([&](const auto& channels) {
                    return write_file(paths.back(), loop_plot(scenario.spacecraft_id, channels));
                  });
  }
  return written.map([&] { return std::move(paths); });
}

Expected<void> to_files(const SimulateOptions& options, const Scenario& scenario,
                        const SimulatedPass& pass, Output& output) {
  if (options.out.empty()) {
    return {};
  }
  auto paths = write_pass(options.out, scenario, pass);
  if (!paths) {
    return Unexpected{paths.error()};
  }
  if (options.plots) {
    const auto plots = write_plots(options.out, scenario, pass);
    if (!plots) {
      return Unexpected{plots.error()};
    }
    paths->insert(paths->end(), plots->begin(), plots->end());
  }
  for (const std::filesystem::path& path : *paths) {
    output.json["files"].push_back(path.string());
    output.text += path.string() + '\n';
  }
  if (options.publish) {  // The service may now be started with this mission file.
    spdlog::info("{} is written", shown((options.out / "mission.toml").string()));
  }
  return {};
}

Expected<void> publish(const Scenario& scenario, const PlacedValues& values,
                       TelemetryOutput& output) {
  ProgressBar progress{"publishing", count_of(values)};
  Expected<void> sent;
  in_order_of_arrival(values, [&, done = std::uint64_t{0}](const auto& placed) mutable {
    if (sent && (sent = output.publish(scenario.spacecraft_id, placed.value))) {
      progress.advance_to(++done);
    }
  });
  return sent;
}

Expected<void> to_bus(const SimulateOptions& options, const Scenario& scenario,
                      const SimulatedPass& pass, Output& output) {
  if (!options.publish) {
    return {};
  }
  return send_telemetry(
             {.bus = {.domain = options.domain, .partition = options.partition},
              .source = "simulate",
              .speed = options.speed,
              .rehearsal = options.now ? std::optional{Rehearsal::OfThePresent} : std::nullopt,
              .kinds = pass.kinds},
             [&](TelemetryOutput& bus) { return publish(scenario, pass.telemetry, bus); })
      .map([&](const PublishedCounts& sent) {
        output.json.update(sent.json("published_"));
        output.text += sent.text() + " published\n";
      });
}

/// Makes the Monte Carlo runs and writes runs.csv and histograms.svg beside their folders.
Expected<void> many(const SimulateOptions& options) {
  // Warnings of the pipelines about single runs would flood the log.
  spdlog::set_level(spdlog::level::err);
  return monte_carlo({.scenario = options.scenario,
                      .out = options.out,
                      .runs = options.runs,
                      .jobs = options.jobs})
      .and_then([&](const MonteCarloResult& result) {
        return write_file(options.out / "runs.csv", runs_csv(result))
            .and_then(
                [&] { return write_file(options.out / "histograms.svg", histograms(result)); })
            .map([&] {
              fmt::print("{}", options.json ? json_line(statistics_json(result))
                                            : statistics_text(result));
            });
      });
}

TaiTime next_second() { return std::chrono::ceil<std::chrono::seconds>(tai_now()); }

}  // namespace

Expected<void> simulate(const SimulateOptions& options) {
  if (options.runs > 0) {
    return many(options);
  }
  const auto start = options.now ? std::optional{next_second()} : std::nullopt;
  const auto scenario = load_scenario(options.scenario, start);
  if (!scenario) {
    return Unexpected{scenario.error()};
  }
  if (options.plots && std::holds_alternative<SpinScenario>(scenario->flight)) {
    return refused(
        fmt::format("--plots: {} is a spinner: there are plots of three-axis spacecraft only",
                    shown(scenario->spacecraft_id)));
  }
  const auto pass = simulated_pass(*scenario);
  if (!pass) {
    return Unexpected{{pass.error().code, fmt::format("{}: {}", shown(options.scenario.string()),
                                                      pass.error().message)}};
  }
  Output output;
  return to_files(options, *scenario, *pass, output)
      .and_then([&] { return to_bus(options, *scenario, *pass, output); })
      .map([&] { report(*scenario, *pass, std::move(output), options.json); });
}

}  // namespace spindrift
