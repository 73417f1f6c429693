#include "services/spindrift/simulate.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <span>
#include <vector>

#include "pipelines/ground_model/coded_telemetry.h"
#include "services/progress/progress_bar.h"
#include "services/scenario/pass_files.h"
#include "services/scenario/scenario.h"
#include "services/scenario/simulated_pass.h"
#include "services/spindrift/telemetry_output.h"

namespace spindrift {
namespace {

nlohmann::json faults_json(const SimulatedPass& pass) {
  nlohmann::json faults = {{"missing", pass.received.missing}};
  for (const Damage damage :
       {Damage::Spoilt, Damage::Spurious, Damage::Doubled, Damage::Interference}) {
    faults[std::string{name_of(damage)}] = count_of(damage, pass);
  }
  return faults;
}

void report(const Scenario& scenario, const SimulatedPass& pass, nlohmann::json outcome,
            const std::string& outcome_text, bool json) {
  const nlohmann::json faults = faults_json(pass);
  if (json) {
    outcome.update({{"spacecraft", scenario.spacecraft_id},
                    {"revolutions", pass.revolutions},
                    {"edges", pass.received.pulses.size()},
                    {"faults", faults}});
    fmt::print("{}\n", outcome.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
    return;
  }
  fmt::print("{}: {} revolutions, {} edges\n", scenario.spacecraft_id, pass.revolutions,
             pass.received.pulses.size());
  for (const auto& [name, count] : faults.items()) {
    fmt::print("  {}: {}\n", name, count.get<std::int64_t>());
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

/// Pulses and coded frames in one order of time.
Expected<void> publish(const Scenario& scenario, const SimulatedPass& pass,
                       const std::vector<CodedFrame>& frames, TelemetryOutput& output) {
  const std::span<const ReceivedPulse> pulses = scenario.telemetry.pulses
                                                    ? std::span{pass.received.pulses}
                                                    : std::span<const ReceivedPulse>{};
  ProgressBar progress{"publishing", pulses.size() + frames.size()};
  auto frame = frames.begin();
  auto pulse = pulses.begin();
  Expected<void> sent;
  for (std::uint64_t done = 1; sent && (frame != frames.end() || pulse != pulses.end()); ++done) {
    const bool pulse_is_next =
        frame == frames.end() || (pulse != pulses.end() && pulse->pulse.t <= frame->t);
    sent = pulse_is_next ? output.publish(scenario.spacecraft_id, (pulse++)->pulse)
                         : output.publish(scenario.spacecraft_id, *frame++);
    progress.advance_to(done);
  }
  return sent;
}

std::vector<TelemetryKind> kinds_of(const SimulatedTelemetry& telemetry) {
  std::vector<TelemetryKind> kinds;
  if (telemetry.pulses) {
    kinds.emplace_back(Kind<Pulse>{});
  }
  if (telemetry.coded) {
    kinds.emplace_back(Kind<CodedFrame>{});
  }
  return kinds;
}

Expected<void> to_bus(const SimulateOptions& options, const Scenario& scenario,
                      const SimulatedPass& pass) {
  const std::vector<CodedFrame> frames =
      scenario.telemetry.coded
          ? coded_telemetry(pass.received, scenario.telemetry.coded_resolution_s)
          : std::vector<CodedFrame>{};
  const auto sent = send_telemetry(
      {.bus = {.domain = options.domain, .partition = options.partition},
       .source = "simulate",
       .speed = options.speed,
       .kinds = kinds_of(scenario.telemetry)},
      [&](TelemetryOutput& output) { return publish(scenario, pass, frames, output); });
  if (!sent) {
    return Unexpected{sent.error()};
  }
  report(scenario, pass, sent->json("published_"), sent->text() + " published\n", options.json);
  return {};
}

}  // namespace

Expected<void> simulate(const SimulateOptions& options) {
  const auto scenario = load_scenario(options.scenario);
  if (!scenario) {
    return Unexpected{scenario.error()};
  }
  const auto pass = simulated_pass(*scenario);
  if (!pass) {
    return Unexpected{{pass.error().code,
                       fmt::format("{}: {}", options.scenario.string(), pass.error().message)}};
  }
  return options.publish ? to_bus(options, *scenario, *pass) : to_files(options, *scenario, *pass);
}

}  // namespace spindrift
