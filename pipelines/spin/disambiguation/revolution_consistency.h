/// @file
/// Whether most revolutions of a pass are consistent in themselves. With a wrong mission file or
/// orbit most are not; the few that agree do so by accident, or have too few measurements to show
/// the contradiction, and an axis from these would be wrong.

#pragma once

#include <algorithm>

#include "pipelines/spin/fix/axis_candidates.h"

namespace spindrift {

class RevolutionConsistency {
 public:
  /// @param window Revolutions.
  explicit RevolutionConsistency(double window) : window_{window} {}

  /// One revolution, after its measurements were screened.
  void count(const FoundCandidates& found) {
    const bool contradicts = is_inconsistent(found);
    if (found || contradicts) {
      counted_ = std::min(counted_ + 1.0, window_);
      share_ += ((contradicts ? 1.0 : 0.0) - share_) / counted_;
    }
  }

  /// Of the last revolutions that could have a fix, most do not contradict themselves.
  bool most_consistent() const { return share_ < 0.5; }

 private:
  double window_;
  double counted_ = 0.0;
  double share_ = 0.0;  ///< Of those that contradict themselves.
};

}  // namespace spindrift
