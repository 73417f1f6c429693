#include "services/spindrift/simulate.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <stop_token>
#include <vector>

#include "services/bus/participant.h"
#include "services/progress/progress_bar.h"
#include "services/publisher/telemetry_publisher.h"
#include "services/scenario/pass_files.h"
#include "services/scenario/scenario.h"
#include "services/scenario/simulated_pass.h"
#include "services/spindrift/pacing.h"

namespace spindrift {
namespace {

constexpr std::chrono::seconds kWaitForSubscriber{30};
constexpr std::chrono::seconds kWaitForArrival{60};

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

Expected<void> publish(PulsePublisher& publisher, const Scenario& scenario,
                       const SimulatedPass& pass, double speed) {
  const auto& pulses = pass.received.pulses;
  Pacing pacing{speed};
  ProgressBar progress{"publishing", static_cast<std::int64_t>(pulses.size())};
  std::int64_t done = 0;
  for (const auto& [pulse, damage] : pulses) {
    pacing.wait_until_due(pulse.t);
    if (auto sent = publisher.publish(scenario.spacecraft_id, pulse, std::stop_token{}); !sent) {
      return sent;
    }
    progress.advance_to(++done);
  }
  return publisher.wait_for_acknowledgments(kWaitForArrival);
}

Expected<void> to_bus(const SimulateOptions& options, const Scenario& scenario,
                      const SimulatedPass& pass) {
  const auto participant =
      bus::Participant::create({.domain = options.domain, .partition = options.partition});
  if (!participant) {
    return Unexpected{participant.error()};
  }
  spdlog::info("{}", participant->description());
  auto publisher = PulsePublisher::create(*participant, "simulate");
  if (!publisher) {
    return Unexpected{publisher.error()};
  }
  if (auto found = publisher->wait_for_subscriber(kWaitForSubscriber); !found) {
    return Unexpected{{ErrorCode::Unavailable,
                       fmt::format("nobody subscribes in domain {}, partition '{}': {}",
                                   options.domain, options.partition, found.error().message)}};
  }
  if (auto sent = publish(*publisher, scenario, pass, options.speed); !sent) {
    return sent;
  }
  report(scenario, pass, {{"published", pass.received.pulses.size()}}, "all published\n",
         options.json);
  return {};
}

}  // namespace

Expected<void> simulate(const SimulateOptions& options) {
  const auto scenario = load_scenario(options.scenario);
  if (!scenario) {
    return Unexpected{scenario.error()};
  }
  if (options.publish && scenario->telemetry.coded) {
    return Unexpected{{ErrorCode::InvalidConfiguration,
                       fmt::format("{}: telemetry.kind: only \"pulses\" can be published; write "
                                   "coded telemetry to files with --out",
                                   options.scenario.string())}};
  }
  const auto pass = simulated_pass(*scenario);
  if (!pass) {
    return Unexpected{{pass.error().code,
                       fmt::format("{}: {}", options.scenario.string(), pass.error().message)}};
  }
  return options.publish ? to_bus(options, *scenario, *pass) : to_files(options, *scenario, *pass);
}

}  // namespace spindrift
