/// @file
/// Residual of an edge against a uniform spin about an axis at rest.

#pragma once

#include "pipelines/spin/sensor_model/edge_prediction.h"
#include "pipelines/spin/types/pulse.h"

namespace spindrift {

/// Residual of a good edge, in the frame `spin` (edge_prediction.h) about the uniform-spin axis.
struct UniformSpinResidual {
  PulseChannel channel;
  double t_s;  ///< Time from any epoch.
  /// Expected azimuth of slit 1 at the edge, counted over turns: phase_rad / 2 pi. The phase at t_s
  /// is not used, because its noise is that of off_rad.
  double turns;
  double off_rad;    ///< Azimuth of slit 1 at the edge less the expected one.
  double sigma_rad;  ///< Noise of `off_rad`: edge-time noise times spin rate.
  PredictedEdge expected;
};

}  // namespace spindrift
