/// @file
/// The scenario of a spinner, played.

#pragma once

#include "pipelines/core/expected.h"
#include "services/simulation/scenario.h"
#include "services/simulation/simulated_pass.h"

namespace spindrift {

/// As simulated_pass. @return NoCoverage or Unobservable where the orbit ends before, or dips below
/// the horizon.
Expected<SimulatedPass> played_pass(const Scenario& scenario, const SpinScenario& flight,
                                    Progress progress);

}  // namespace spindrift
