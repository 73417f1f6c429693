/// @file
/// Simulation of a lost satellite.

#pragma once

#include "pipelines/core/expected.h"
#include "services/simulation/scenario.h"
#include "services/simulation/simulated_pass.h"

namespace spindrift {

/// Simulates the pass, as simulated_pass. Its truth: at start and end the state as at the events of
/// a separation; history (three_axis_pass.h); gyro_bias_deg_s, missing, sun_outliers.
/// @return NoCoverage where the orbit or the field ends too early.
Expected<SimulatedPass> played_pass(const Scenario& scenario, const TumblingScenario& flight);

}  // namespace spindrift
