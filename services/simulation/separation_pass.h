/// @file
/// The scenario of a separation, played.

#pragma once

#include "pipelines/core/expected.h"
#include "services/simulation/scenario.h"
#include "services/simulation/simulated_pass.h"

namespace spindrift {

/// As simulated_pass. Its truth: of T1 to T4 t_tai_ns, q_icrf_body_xyzw, w_body_deg_s and
/// sun_off_deg, from -Z to the Sun; gyro_bias_deg_s; how many samples are missing; t_tai_ns of
/// sun_outliers.
/// @return NoCoverage or Unobservable where the orbit ends before, or has no orbit frame.
Expected<SimulatedPass> played_pass(const Scenario& scenario, const SeparationScenario& flight);

}  // namespace spindrift
