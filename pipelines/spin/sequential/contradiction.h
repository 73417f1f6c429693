/// @file
/// Whether fixes say that the axis is another one than those that are followed.
///
/// Single fixes stray, and where the noise is more than stated most do. So it takes more of them
/// against the axis than for it (a cumulative sum, which begins anew wherever it comes to 0), and
/// the mean of all since then must lie elsewhere, by the scatter that they show.

#pragma once

#include <span>

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
