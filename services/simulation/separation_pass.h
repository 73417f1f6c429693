/// @file
/// Simulation of a separation.

#pragma once

#include "pipelines/core/expected.h"
#include "services/simulation/scenario.h"
#include "services/simulation/simulated_pass.h"

namespace spindrift {

/// Simulates the pass, as simulated_pass. Its truth: t_tai_ns, q_icrf_body_xyzw, w_body_deg_s and
/// sun_off_deg (from -Z to the Sun) at T1 to T4; gyro_bias_deg_s; missing (a number); t_tai_ns of
/// sun_outliers.
/// @return NoCoverage or Unobservable where the orbit ends too early, or has no orbit frame.
Expected<SimulatedPass> played_pass(const Scenario& scenario, const SeparationScenario& flight);

}  // namespace spindrift
