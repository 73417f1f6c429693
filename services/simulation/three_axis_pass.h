/// @file
/// Functions shared by the simulations of all flights of a three-axis spacecraft.

#pragma once

#include <nlohmann/json.hpp>

#include "pipelines/core/expected.h"
#include "pipelines/ephemeris/orbit.h"
#include "pipelines/ground_model/flights/three_axis_flights.h"
#include "services/simulation/scenario.h"
#include "services/simulation/simulated_pass.h"

namespace spindrift {

/// Returns the truth at `t_s` since the start: t_tai_ns, q_icrf_body_xyzw, w_body_deg_s and
/// sun_off_deg (from -Z to the Sun). @return NoCoverage where the orbit does not reach.
Expected<nlohmann::ordered_json> true_state(const Scenario& scenario, const BodyMotion& motion,
                                            double t_s);

/// Returns the truth at start and end and, every ten seconds between them, `history`: t_tai_ns; x,
/// y, z, w of q_icrf_body; body rates in deg/s. @return NoCoverage as for `true_state`.
Expected<nlohmann::ordered_json> start_and_end(const Scenario& scenario, const BodyMotion& motion);

/// @param truth Truth to which gyro_bias_deg_s, missing and sun_outliers are added.
SimulatedPass three_axis_pass(const ThreeAxisSensors& sensors, FlownBody flown,
                              nlohmann::ordered_json truth, std::string mission_toml);

}  // namespace spindrift
