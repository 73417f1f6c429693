/// @file
/// Where an orbit steps: segments that do not meet, and states that nothing carries from one to the
/// next. One side or the other is wrong, or there was a manoeuvre, which may have moved the
/// attitude as well: what rests on both sides is not to be believed unseen.

#pragma once

#include <optional>
#include <span>
#include <vector>

#include "pipelines/core/assessment.h"
#include "pipelines/ephemeris/orbit.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

struct OrbitStep {
  TaiTime from;     ///< The last instant before the step.
  TaiTime to;       ///< The first instant behind it: the same where segments touch.
  int line;         ///< The first state behind the step stands there in the OEM.
  double off_km;    ///< The positions of both sides differ by this at `to`.
  double off_km_s;  ///< The velocities of both sides differ by this at `to`.
};

/// In order of time. Segments are compared where the later one begins to be used, as each has it
/// there; one whose states end before is carried on by two-body motion. They do not meet where that
/// is more than states printed to 1 km and 1 m/s explain, and what two-body motion lacks. 1 km is
/// 0.008 deg of the nadir direction near the Earth, half a sigma of the axis of a good pass, and
/// 1 m/s makes less of it in ten minutes. Within a segment steps are those of `orbit_jumps`.
/// @return None for an orbit of elements.
std::vector<OrbitStep> orbit_steps(const Orbit& orbit);
std::vector<OrbitStep> orbit_steps(const OrbitEphemeris& ephemeris);

/// The first that lies within what was used from `first` to `last`.
std::optional<OrbitStep> step_within(std::span<const OrbitStep> steps, TaiTime first, TaiTime last);

/// The doubt that it casts on what rests on both its sides.
Reason reason_of(const OrbitStep& step);

}  // namespace spindrift
