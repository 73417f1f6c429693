/// @file
/// The orbit frame: z to the Earth's centre, y against the orbit normal, x = y x z, ahead.

#pragma once

#include <Eigen/Geometry>

#include "pipelines/core/expected.h"
#include "pipelines/ephemeris/orbit_state.h"

namespace spindrift {

/// @return q_icrf_orbit: v_icrf = q v_orbit q*. A body's attitude in the frame is q* q_icrf_body.
///         Unobservable where the velocity is vertical: there is no orbit normal.
Expected<Eigen::Quaterniond> orbit_frame(const OrbitState& spacecraft);

}  // namespace spindrift
