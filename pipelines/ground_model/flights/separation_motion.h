/// @file
/// Motion of a body from separation from the launcher until it points at the Sun: it drifts without
/// control, relays damp its rates, then -Z turns to the Sun and stays there. The laws know the true
/// rate and Sun.

#pragma once

#include "pipelines/core/expected.h"
#include "pipelines/ground_model/control/thrusters.h"
#include "pipelines/ground_model/flights/body_flight.h"

namespace spindrift {

struct SeparationControl {
  ThrusterDesign thrusters;
  double dead_band_rad_s;  ///< Rate about an axis up to which its relay is off.
  double slew_rad_s;       ///< Largest rate of the turn to the Sun.
  /// Control period.
  double period_s = 0.05;
};

struct SeparationTruth {
  BodyTruth body;  ///< Body from T1, the start.
  SeparationControl control;
  double control_on_s;   ///< T2: start of rate damping, since the start.
  double acquisition_s;  ///< T3: start of Sun acquisition; not before T2.
};

/// @return NoCoverage where the orbit or the field ends too early; InvalidConfiguration for an
///         impossible inertia, thrusters or times, and a body too fast for the period.
Expected<BodyMotion> separation_motion(const SeparationTruth& truth, const Orbit& orbit);

}  // namespace spindrift
