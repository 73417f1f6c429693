/// @file
/// Discontinuities of an orbit: segments that do not meet, and states that do not follow from the
/// one before. Either one side is wrong, or there was a manoeuvre, which may have changed the
/// attitude as well: results that rest on both sides are doubtful.

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
  TaiTime to;       ///< The first instant after the step: the same where segments touch.
  int line;         ///< Line in the OEM of the first state after the step.
  double off_km;    ///< Distance between the positions of both sides at `to`.
  double off_km_s;  ///< Difference between the velocities of both sides at `to`.
};

/// Returns the steps in order of time. Two segments are compared at the start of use of the later
/// one, each by its own state there; one whose states end earlier is propagated by two-body motion.
/// They do not meet where the difference is more than states printed to 1 km and 1 m/s, and the
/// perturbations of two-body motion, explain. 1 km is 0.008 deg of the nadir direction near the
/// Earth, half a sigma of the axis of a good pass, and 1 m/s makes less of it in ten minutes.
/// Within a segment steps are those of `orbit_jumps`.
/// @return Empty for an orbit of elements.
std::vector<OrbitStep> orbit_steps(const Orbit& orbit);
std::vector<OrbitStep> orbit_steps(const OrbitEphemeris& ephemeris);

/// Returns the first step within the span from `first` to `last`.
std::optional<OrbitStep> step_within(std::span<const OrbitStep> steps, TaiTime first, TaiTime last);

/// Returns the reason to doubt a result that rests on both sides of the step.
Reason reason_of(const OrbitStep& step);

}  // namespace spindrift
