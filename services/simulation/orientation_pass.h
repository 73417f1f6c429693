/// @file
/// Simulation of a satellite that turns to an attitude by its wheels.

#pragma once

#include "pipelines/core/expected.h"
#include "services/simulation/scenario.h"
#include "services/simulation/simulated_pass.h"

namespace spindrift {

/// Simulates the pass, as simulated_pass. Its truth is that of a tumbling satellite with, of the
/// control, pointing_s and settled_s (null: never), last_off_deg, wheel_nms_most and
/// wheel_rpm_most; of its loops phase_margin_deg, gain_margin_db and crossover_rad_s.
/// @return NoCoverage where the orbit or the field ends too early.
Expected<SimulatedPass> played_pass(const Scenario& scenario, const OrientationScenario& flight);

}  // namespace spindrift
