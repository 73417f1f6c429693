/// @file
/// Scenario of a pass of a spinner: the truth, the telemetry and the faults.

#pragma once

#include "pipelines/ground_model/link/pulse_link.h"
#include "pipelines/ground_model/sensors/spin_edges.h"
#include "pipelines/time/tai_time.h"
#include "services/mission/document.h"
#include "services/mission/scalar.h"

namespace spindrift {

struct SimulatedTelemetry {
  bool pulses;
  bool coded;
  double coded_resolution_s;
};

struct SpinScenario {
  SpinTruth truth;
  PulseLink link;
  SimulatedTelemetry telemetry;
};

/// Adds the problems that the schema cannot detect.
void check_spin_scenario(TomlDocument& document);

/// @param values Values of a scenario without problems.
SpinScenario spin_scenario(const TomlValues& values, TaiTime start);

}  // namespace spindrift
