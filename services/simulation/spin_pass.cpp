#include "services/simulation/spin_pass.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "pipelines/ground_model/link/coded_telemetry.h"
#include "services/base/progress_bar.h"
#include "services/simulation/spin_truth.h"

namespace spindrift {
namespace {

constexpr int kSlices = 200;

Expected<ReceivedSpin> received(const Scenario& scenario, const SpinScenario& flight,
                                Progress progress) {
  SpinEdges source{flight.truth, scenario.orbit};
  std::vector<TrueEdge> edges;
  std::optional<ProgressBar> bar;
  if (progress == Progress::Shown) {
    bar.emplace("simulating", kSlices);
  }
  for (int slice = 1; slice <= kSlices; ++slice) {
    const auto more = source.until(scenario.duration_s * slice / kSlices);
    if (!more) {
      return Unexpected{more.error()};
    }
    edges.insert(edges.end(), more->begin(), more->end());
    if (bar) {
      bar->advance_to(static_cast<std::uint64_t>(slice));
    }
  }
  return ReceivedSpin{.pass = receive(flight.link, edges, scenario.start, scenario.duration_s,
                                      source.revolutions()),
                      .revolutions = source.revolutions()};
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

PlacedValues telemetry_of(const SimulatedTelemetry& telemetry, const ReceivedPass& pass) {
  PlacedValues values;
  std::int64_t place = 0;
  const auto append = [&]<class Value>(const Value& value) {
    values.of<Value>().push_back({.place = {place++}, .value = value});
  };
  std::vector<CodedFrame> frames;
  if (telemetry.coded) {
    frames = coded_telemetry(pass, telemetry.coded_resolution_s);
  }
  auto frame = frames.begin();
  if (telemetry.pulses) {
    for (const ReceivedPulse& received : pass.pulses) {
      for (; frame != frames.end() && frame->t < received.pulse.t; ++frame) {
        append(*frame);
      }
      append(received.pulse);
    }
  }
  for (; frame != frames.end(); ++frame) {
    append(*frame);
  }
  return values;
}

std::vector<Counted> faults_of(const ReceivedPass& pass) {
  std::vector<Counted> faults = {{"missing", pass.missing}};
  for (const Damage damage :
       {Damage::Spoilt, Damage::Spurious, Damage::Doubled, Damage::Interference}) {
    faults.push_back({name_of(damage), count_of(damage, pass)});
  }
  return faults;
}

}  // namespace

Expected<SimulatedPass> played_pass(const Scenario& scenario, const SpinScenario& flight,
                                    Progress progress) {
  const auto spin = received(scenario, flight, progress);
  if (!spin) {
    return Unexpected{spin.error()};
  }
  auto truth = spin_truth(flight.truth, scenario.orbit, *spin);
  if (!truth) {
    return Unexpected{std::move(truth.error())};
  }
  return SimulatedPass{.kinds = kinds_of(flight.telemetry),
                       .telemetry = telemetry_of(flight.telemetry, spin->pass),
                       .mission_toml = scenario.mission_toml,
                       .truth = std::move(*truth),
                       .made = {{"revolutions", spin->revolutions},
                                {"edges", static_cast<std::int64_t>(spin->pass.pulses.size())}},
                       .faults = faults_of(spin->pass)};
}

}  // namespace spindrift
