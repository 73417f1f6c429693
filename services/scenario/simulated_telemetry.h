/// @file
/// A simulated pass as telemetry, by kind.

#pragma once

#include <vector>

#include "services/scenario/scenario.h"
#include "services/scenario/simulated_pass.h"
#include "services/telemetry/by_kind.h"

namespace spindrift {

/// That the scenario asks for.
std::vector<TelemetryKind> kinds_of(const SimulatedTelemetry& telemetry);

/// Values of these kinds; their arrival is their place in one order of time.
TelemetryValues telemetry_of(const Scenario& scenario, const SimulatedPass& pass);

}  // namespace spindrift
