/// @file
/// Simulations of the flights of a three-axis spacecraft.

#pragma once

#include "pipelines/core/expected.h"
#include "services/simulation/scenario.h"
#include "services/simulation/simulated_pass.h"

namespace spindrift {

/// @name Simulate the pass, as simulated_pass
/// The truth of each has gyro_bias_deg_s, missing (a number) and t_tai_ns of sun_outliers. A state
/// is t_tai_ns, q_icrf_body_xyzw, w_body_deg_s and sun_off_deg (from -Z to the Sun).
/// @{

/// Simulates a separation. Its truth: the states at T1 to T4.
/// @return NoCoverage or Unobservable where the orbit ends too early, or has no orbit frame.
Expected<SimulatedPass> played_pass(const Scenario& scenario, const SeparationScenario& flight);

/// Simulates a lost satellite. Its truth: the states at start and end, and every ten seconds
/// between them `history`: t_tai_ns; x, y, z, w of q_icrf_body; body rates in deg/s.
/// @return NoCoverage where the orbit or the field ends too early.
Expected<SimulatedPass> played_pass(const Scenario& scenario, const TumblingScenario& flight);

/// Simulates a satellite that turns to an attitude by its wheels. Its truth is that of a tumbling
/// satellite with, of the control, pointing_s and settled_s (null: never), last_off_deg,
/// wheel_nms_most and wheel_rpm_most; of its loops phase_margin_deg, gain_margin_db and
/// crossover_rad_s. @return NoCoverage where the orbit or the field ends too early.
Expected<SimulatedPass> played_pass(const Scenario& scenario, const OrientationScenario& flight);

/// Simulates a satellite that is lost and rescued. Its truth is that of a tumbling satellite with
/// lost_s, control_s and reached_s (since the start; null: never), filter_off_deg (of the attitude
/// when control began; null: it did not) and last_off_deg.
/// @return NoCoverage where the orbit or the field ends too early.
Expected<SimulatedPass> played_pass(const Scenario& scenario, const RescueScenario& flight);
/// @}

}  // namespace spindrift
