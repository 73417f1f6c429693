/// @file
/// Tests whether the fixes contradict all axes that filters follow.
///
/// Single fixes deviate, and most do where the noise is more than stated. So the cumulative sum of
/// fixes against the axis, less those for it, must reach a limit, and the mean of all fixes since
/// the sum was last 0 must differ from the axis by more than their observed scatter explains.

#pragma once

#include "pipelines/spin/mean/mean_axis.h"
#include "pipelines/spin/sequential/hypotheses.h"
#include "pipelines/spin/sequential/starting_points.h"

namespace spindrift {

class Contradiction {
 public:
  /// Counts fixes for or against the followed axes.
  void note(const Hypotheses& followed, const StartingPoints::Known& said);

  /// @param edges_doubt True when the edges contradict the axis too; then fewer fixes suffice.
  bool stands(const Hypotheses& followed, bool edges_doubt) const;

 private:
  int against_ = 0;  ///< Fixes against the axes less those for them, never below 0.
  MeanAxis mean_;    ///< Mean of all fixes since the count was last 0.
};

}  // namespace spindrift
