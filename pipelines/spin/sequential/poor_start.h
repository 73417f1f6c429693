/// @file
/// A filter that began at an axis known to degrees, where edges need not be linear: it may have
/// come to rest beside the truth, with edges that fit. (A chord across the middle of the Earth's
/// disc is the longest there is: axes on either side of it see the same.) The fixes tell, in time.

#pragma once

#include <optional>

#include "pipelines/spin/mean/mean_axis.h"
#include "pipelines/spin/sequential/starting_points.h"
#include "pipelines/spin/types/products.h"

namespace spindrift {

class PoorStart {
 public:
  void begin(const StartingPoint& point);

  /// @param followed Where the filter is now.
  void note(const SpinFix& fix, const StartingPoint& followed);

  /// Until the mean of the fixes since then, known to a degree, is where the filter is.
  bool unconfirmed() const { return fixes_.has_value(); }

 private:
  std::optional<MeanAxis> fixes_;  ///< Empty where there is nothing to confirm.
};

}  // namespace spindrift
