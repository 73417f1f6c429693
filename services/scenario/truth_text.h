/// @file
/// The truth about a simulated pass, for those who judge what was made of it.

#pragma once

#include <string>

#include "pipelines/core/expected.h"
#include "services/scenario/scenario.h"
#include "services/scenario/simulated_pass.h"

namespace spindrift {

/// A JSON object: axis (ra_deg, dec_deg), rpm at the start and its drift wdot (rad/s^2), number of
/// revolutions; how many edges are missing, spoilt, spurious, doubled or hit by interference;
/// bad_edges as [t_tai_ns, channel, what is wrong]; sun_angle_deg, earth_angle_deg and rho_deg (of
/// the spherical Earth) at the start; where there is any, nutation (half_angle_deg, inertia_ratio,
/// period_s at the start, phase_deg) and coning (tilt_deg, azimuth_deg).
/// @return InvalidConfiguration where the orbit has no state at the start, or one below the
/// horizon.
Expected<std::string> truth_text(const Scenario& scenario, const SimulatedPass& pass);

}  // namespace spindrift
