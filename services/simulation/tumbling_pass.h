/// @file
/// The scenario of a lost satellite, played.

#pragma once

#include "pipelines/core/expected.h"
#include "services/simulation/scenario.h"
#include "services/simulation/simulated_pass.h"

namespace spindrift {

/// As simulated_pass. Its truth: of start and end what a separation has of its events; history
/// (three_axis_pass.h); gyro_bias_deg_s, missing, sun_outliers.
/// @return NoCoverage where the orbit or the field ends before.
Expected<SimulatedPass> played_pass(const Scenario& scenario, const TumblingScenario& flight);

}  // namespace spindrift
