/// @file
/// Truth of a simulated pass of a spinner, as a reference for its solutions.

#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>

#include "pipelines/core/expected.h"
#include "pipelines/ephemeris/orbit.h"
#include "pipelines/ground_model/link/pulse_link.h"
#include "pipelines/ground_model/sensors/spin_edges.h"

namespace spindrift {

struct ReceivedSpin {
  ReceivedPass pass;
  std::int64_t revolutions;
};

/// Returns the number of received edges with that damage.
std::int64_t count_of(Damage damage, const ReceivedPass& pass);

/// Returns the axis (ra_deg, dec_deg), rpm at the start and its drift wdot (rad/s^2), number of
/// revolutions; the numbers of edges missing, spoilt, spurious, doubled or hit by interference;
/// bad_edges as [t_tai_ns, channel, damage]; sun_angle_deg, earth_angle_deg and rho_deg (of the
/// spherical Earth) at the start; where there is any, nutation (half_angle_deg, inertia_ratio,
/// period_s at the start, phase_deg) and coning (tilt_deg, azimuth_deg).
/// @return NoCoverage where the orbit has no state at the start.
Expected<nlohmann::ordered_json> spin_truth(const SpinTruth& truth, const Orbit& orbit,
                                            const ReceivedSpin& spin);

}  // namespace spindrift
