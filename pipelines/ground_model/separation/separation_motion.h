/// @file
/// A body from separation from the launcher until it looks at the Sun: it drifts without torque;
/// relays damp its rates; -Z turns to the Sun and stays there. The laws know rate and Sun as they
/// are.

#pragma once

#include <Eigen/Core>

#include "pipelines/core/expected.h"
#include "pipelines/ephemeris/orbit.h"
#include "pipelines/frames/body_state.h"
#include "pipelines/ground_model/control/thrusters.h"
#include "pipelines/ground_model/dynamics/body_motion.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

struct SeparationControl {
  ThrusterDesign thrusters;
  double dead_band_rad_s;  ///< Relays are off about an axis that turns no faster.
  double slew_rad_s;       ///< Of the turn to the Sun, at most.
  /// The laws choose the torque anew so often. It is the step of the body, too.
  double period_s = 0.05;
};

/// Seconds behind separation, in order.
struct SeparationPhases {
  double control_on_s;   ///< T2: the relays are on.
  double acquisition_s;  ///< T3: the Sun is looked for.
  double end_s;
};

struct SeparationTruth {
  TaiTime separation;  ///< T1
  BodyState at_separation;
  Eigen::Matrix3d inertia_kg_m2;
  SeparationControl control;
  SeparationPhases phases;
};

/// @return NoCoverage where the orbit ends before; InvalidConfiguration for a body, thrusters or
///         times that cannot be, and for a body that turns too fast for the period.
Expected<BodyMotion> separation_motion(const SeparationTruth& truth, const Orbit& orbit);

}  // namespace spindrift
