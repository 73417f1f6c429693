/// @file
/// Residual of an edge against a uniform spin about an axis at rest.

#pragma once

#include "pipelines/spin/sensor_model/edge_prediction.h"
#include "pipelines/spin/types/pulse.h"

namespace spindrift {

/// Of a good edge, in the frame `spin` (edge_prediction.h), the steady solution's axis its third.
struct UniformSpinResidual {
  PulseChannel channel;
  double t_s;  ///< From any epoch.
  /// Azimuth of slit 1 at which the edge was expected, counted on from turn to turn: phase_rad / 2
  /// pi. Not that at t_s, whose noise is the one in off_rad.
  double turns;
  double off_rad;    ///< The azimuth that slit 1 had, less the one at which the edge was expected.
  double sigma_rad;  ///< Of `off_rad`: the noise of the edge's time by the rate.
  PredictedEdge expected;
};

}  // namespace spindrift
