/// @file
/// The scenario of a spinner, played.

#pragma once

#include "pipelines/core/expected.h"
#include "services/scenario/scenario.h"
#include "services/scenario/simulated_pass.h"

namespace spindrift {

/// As simulated_pass. @return NoCoverage or Unobservable where the orbit ends before, or dips below
/// the horizon.
Expected<SimulatedPass> played_pass(const Scenario& scenario, const SpinScenario& flight,
                                    Progress progress);

}  // namespace spindrift
