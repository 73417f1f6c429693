/// @file
/// The scenario of a pass of a spinner: what there really is, what is sent down, and what goes
/// wrong.

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

/// Adds the problems that the schema cannot see.
void check_spin_scenario(TomlDocument& document);

/// @param values In which no problem was found.
SpinScenario spin_scenario(const TomlValues& values, TaiTime start);

}  // namespace spindrift
