/// @file
/// Checks whether later fixes confirm a filter that began at an axis known only to degrees. Over
/// such a distance edges are not linear, and the filter may converge to a wrong axis that fits
/// them: a chord across the middle of the Earth's disc looks the same from either side.

#pragma once

#include <optional>

#include "pipelines/spin/mean/mean_axis.h"
#include "pipelines/spin/sequential/starting_points.h"
#include "pipelines/spin/types/products.h"

namespace spindrift {

class StartConfirmation {
 public:
  void begin(const StartingPoint& point);

  /// @param followed Present axis of the filter.
  void note(const SpinFix& fix, const StartingPoint& followed);

  /// True until the mean of the fixes since the start is known to a degree and agrees with the
  /// filter.
  bool unconfirmed() const { return fixes_.has_value(); }

 private:
  std::optional<MeanAxis> fixes_;  ///< Mean of the fixes; empty when nothing needs confirmation.
};

}  // namespace spindrift
