/// @file
/// Simulation of a spinner.

#pragma once

#include "pipelines/core/expected.h"
#include "services/simulation/scenario.h"
#include "services/simulation/simulated_pass.h"

namespace spindrift {

/// Simulates the pass, as simulated_pass.
/// @return NoCoverage or Unobservable where the orbit ends too early, or dips below the horizon.
Expected<SimulatedPass> played_pass(const Scenario& scenario, const SpinScenario& flight,
                                    Progress progress);

}  // namespace spindrift
