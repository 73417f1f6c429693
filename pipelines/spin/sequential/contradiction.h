/// @file
/// Tests whether the fixes confirm the axis that a filter began at, and whether they contradict all
/// axes that filters follow.

#pragma once

#include <optional>

#include "pipelines/spin/mean/mean_axis.h"
#include "pipelines/spin/sequential/hypotheses.h"
#include "pipelines/spin/sequential/starting_points.h"
#include "pipelines/spin/types/products.h"

namespace spindrift {

/// Checks whether later fixes confirm a filter that began at an axis known only to degrees. Over
/// such a distance edges are not linear, and the filter may converge to a wrong axis that fits
/// them: a chord across the middle of the Earth's disc looks the same from either side.
class StartConfirmation {
 public:
  void begin(const StartingPoint& point);

  /// @param followed Present axis of the filter.
  void add_fix(const SpinFix& fix, const StartingPoint& followed);

  /// True until the mean of the fixes since the start is known to a degree and agrees with the
  /// filter.
  bool unconfirmed() const { return fixes_.has_value(); }

 private:
  std::optional<MeanAxis> fixes_;  ///< Mean of the fixes; empty when nothing needs confirmation.
};

/// Tests whether the fixes contradict all axes that filters follow. Single fixes deviate, and most
/// do where the noise is more than stated. So the cumulative sum of fixes against the axis, less
/// those for it, must reach a limit, and the mean of all fixes since the sum was last 0 must differ
/// from the axis by more than their observed scatter explains.
class Contradiction {
 public:
  /// Counts fixes for or against the followed axes.
  void count_fix(const Hypotheses& followed, const StartingPoints::Known& said);

  /// @param edges_doubt True when the edges contradict the axis too; then fewer fixes suffice.
  bool stands(const Hypotheses& followed, bool edges_doubt) const;

 private:
  int against_ = 0;  ///< Fixes against the axes less those for them, never below 0.
  MeanAxis mean_;    ///< Mean of all fixes since the count was last 0.
};

}  // namespace spindrift
