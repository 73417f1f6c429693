/// @file
/// Whether the fixes contradict all axes that filters follow.
///
/// Single fixes deviate, and most do where the noise is more than stated. So a cumulative sum of
/// fixes against the axis, less those for it, must reach a limit, and the mean of all fixes since
/// the sum was last 0 must differ from the axis by more than their observed scatter explains.

#pragma once

#include "pipelines/spin/mean/mean_axis.h"
#include "pipelines/spin/sequential/hypotheses.h"
#include "pipelines/spin/sequential/starting_points.h"

namespace spindrift {

class Contradiction {
 public:
  /// What so many fixes say.
  void note(const Hypotheses& followed, const StartingPoints::Known& said);

  /// @param edges_doubt The edges speak against the axis as well: then less is needed.
  bool stands(const Hypotheses& followed, bool edges_doubt) const;

 private:
  int against_ = 0;  ///< Fixes, less those for it.
  MeanAxis mean_;    ///< Of what all of them say, since that was last 0.
};

}  // namespace spindrift
