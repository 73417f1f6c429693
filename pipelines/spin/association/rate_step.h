/// @file
/// Detection of a step of the spin rate: the last edges of the channel that sets the clock are
/// equally spaced, but not as the clock expects.

#pragma once

#include <deque>
#include <optional>

#include "pipelines/spin/association/period_search.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

class RateStepDetector {
 public:
  /// @param good The clock expects an edge there.
  void add(TaiTime t, bool good);
  /// A copy of the last one that the clock expects where it came: it stands for that.
  void replace_last(TaiTime t) {
    if (!recent_.empty()) {
      recent_.back() = {.t = t, .good = true};
    }
  }

  /// The comb of the last edges, where the clock should be set by it: the last one lies on it and
  /// is not good, and it is not the clock's own.
  /// @param noise_s Standard deviation of an edge as it was seen so far.
  /// @param period_s The clock's.
  std::optional<PulseTrain> new_pulse_train(double noise_s, double period_s) const;

  void forget() { recent_.clear(); }

 private:
  struct ReferenceEdge {
    TaiTime t;
    bool good;
  };

  std::deque<ReferenceEdge> recent_;
};

}  // namespace spindrift
