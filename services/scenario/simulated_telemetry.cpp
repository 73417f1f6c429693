#include "services/scenario/simulated_telemetry.h"

#include <cstdint>

#include "pipelines/ground_model/coded_telemetry.h"

namespace spindrift {

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

TelemetryValues telemetry_of(const Scenario& scenario, const SimulatedPass& pass) {
  TelemetryValues values;
  std::int64_t arrival = 0;
  const auto append = [&]<class Value>(const Value& value) {
    values.of<Value>().push_back({.arrival = arrival++, .value = value});
  };
  std::vector<CodedFrame> frames;
  if (scenario.telemetry.coded) {
    frames = coded_telemetry(pass.received, scenario.telemetry.coded_resolution_s);
  }
  auto frame = frames.begin();
  if (scenario.telemetry.pulses) {
    for (const ReceivedPulse& received : pass.received.pulses) {
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

}  // namespace spindrift
