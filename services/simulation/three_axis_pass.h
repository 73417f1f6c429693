/// @file
/// What the passes of all flights of a three-axis spacecraft have in common.

#pragma once

#include <nlohmann/json.hpp>

#include "pipelines/core/expected.h"
#include "pipelines/ephemeris/orbit.h"
#include "pipelines/ground_model/flights/three_axis_flights.h"
#include "services/simulation/scenario.h"
#include "services/simulation/simulated_pass.h"

namespace spindrift {

/// The truth `t_s` behind the start: t_tai_ns, q_icrf_body_xyzw, w_body_deg_s and sun_off_deg, from
/// -Z to the Sun. @return NoCoverage where the orbit does not reach.
Expected<nlohmann::ordered_json> true_state(const Scenario& scenario, const BodyMotion& motion,
                                            double t_s);

/// The truth at start and end, and between them, every ten seconds, `history`: t_tai_ns; x, y, z, w
/// of q_icrf_body; body rates in deg/s. @return likewise.
Expected<nlohmann::ordered_json> start_and_end(const Scenario& scenario, const BodyMotion& motion);

/// @param truth To which gyro_bias_deg_s, missing and sun_outliers are added.
/// @param mission_toml Of the pass.
SimulatedPass three_axis_pass(const ThreeAxisSensors& sensors, FlownBody flown,
                              nlohmann::ordered_json truth, std::string mission_toml);

}  // namespace spindrift
