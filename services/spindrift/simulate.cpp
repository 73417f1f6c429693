#include "services/spindrift/simulate.h"

#include <fmt/format.h>

#include <chrono>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>

#include "pipelines/core/shown.h"
#include "services/clock/wall_clock.h"
#include "services/progress/progress_bar.h"
#include "services/scenario/pass_files.h"
#include "services/scenario/scenario.h"
#include "services/scenario/simulated_pass.h"
#include "services/spindrift/telemetry_output.h"
#include "services/standard_error/warning.h"
#include "services/words/counted.h"
#include "services/words/json_key.h"
#include "services/words/json_line.h"

namespace spindrift {
namespace {

nlohmann::json counts_json(const std::vector<Counted>& counts) {
  nlohmann::json object = nlohmann::json::object();
  for (const auto& [plural, count] : counts) {
    object[json_key(plural)] = count;
  }
  return object;
}

void report(const Scenario& scenario, const SimulatedPass& pass, nlohmann::json outcome,
            const std::string& outcome_text, bool json) {
  if (json) {
    outcome.update(counts_json(pass.made));
    outcome.update({{"spacecraft", scenario.spacecraft_id}, {"faults", counts_json(pass.faults)}});
    fmt::print("{}", json_line(with_warnings(outcome)));
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
  fmt::print("{}", outcome_text);
}

Expected<void> to_files(const SimulateOptions& options, const Scenario& scenario,
                        const SimulatedPass& pass) {
  const auto paths = write_pass(options.out, scenario, pass);
  if (!paths) {
    return Unexpected{paths.error()};
  }
  std::vector<std::string> names;
  std::string lines;
  for (const std::filesystem::path& path : *paths) {
    names.push_back(path.string());
    lines += path.string() + '\n';
  }
  report(scenario, pass, {{"files", names}}, lines, options.json);
  return {};
}

Expected<void> publish(const Scenario& scenario, const TelemetryValues& values,
                       TelemetryOutput& output) {
  ProgressBar progress{"publishing", count_of(values)};
  Expected<void> sent;
  in_order_of_arrival(values, [&, done = std::uint64_t{0}](const auto& arrived) mutable {
    if (sent && (sent = output.publish(scenario.spacecraft_id, arrived.value))) {
      progress.advance_to(++done);
    }
  });
  return sent;
}

Expected<void> to_bus(const SimulateOptions& options, const Scenario& scenario,
                      const SimulatedPass& pass) {
  const auto sent = send_telemetry(
      {.bus = {.domain = options.domain, .partition = options.partition},
       .source = "simulate",
       .speed = options.speed,
       .rehearsal = options.now ? std::optional{Rehearsal::OfThePresent} : std::nullopt,
       .kinds = pass.kinds},
      [&](TelemetryOutput& output) { return publish(scenario, pass.telemetry, output); });
  if (!sent) {
    return Unexpected{sent.error()};
  }
  report(scenario, pass, sent->json("published_"), sent->text() + " published\n", options.json);
  return {};
}

TaiTime next_second() { return std::chrono::ceil<std::chrono::seconds>(tai_now()); }

}  // namespace

Expected<void> simulate(const SimulateOptions& options) {
  const auto start = options.now ? std::optional{next_second()} : std::nullopt;
  const auto scenario = load_scenario(options.scenario, start);
  if (!scenario) {
    return Unexpected{scenario.error()};
  }
  const auto pass = simulated_pass(*scenario);
  if (!pass) {
    return Unexpected{{pass.error().code, fmt::format("{}: {}", shown(options.scenario.string()),
                                                      pass.error().message)}};
  }
  return options.publish ? to_bus(options, *scenario, *pass) : to_files(options, *scenario, *pass);
}

}  // namespace spindrift
