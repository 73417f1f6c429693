/// @file
/// A body from separation from the launcher until it looks at the Sun: it drifts without control;
/// relays damp its rates; -Z turns to the Sun and stays there. The laws know rate and Sun as they
/// are.

#pragma once

#include "pipelines/core/expected.h"
#include "pipelines/ground_model/control/thrusters.h"
#include "pipelines/ground_model/flights/body_flight.h"

namespace spindrift {

struct SeparationControl {
  ThrusterDesign thrusters;
  double dead_band_rad_s;  ///< Relays are off about an axis that turns no faster.
  double slew_rad_s;       ///< Of the turn to the Sun, at most.
  /// The laws choose the torque anew so often.
  double period_s = 0.05;
};

struct SeparationTruth {
  BodyTruth body;  ///< From T1.
  SeparationControl control;
  double control_on_s;   ///< T2: the relays are on; behind the start.
  double acquisition_s;  ///< T3: the Sun is looked for; not earlier.
};

/// @return NoCoverage where the orbit or the field ends before; InvalidConfiguration for a body,
///         thrusters or times that cannot be, and for a body that turns too fast for the period.
Expected<BodyMotion> separation_motion(const SeparationTruth& truth, const Orbit& orbit);

}  // namespace spindrift
