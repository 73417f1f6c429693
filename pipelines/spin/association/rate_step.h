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
  /// @param good Whether the clock expects an edge at `t`.
  void add(TaiTime t, bool good);
  /// Replaces the last edge by a copy of it that came where the clock expects it.
  void replace_last(TaiTime t) {
    if (!recent_.empty()) {
      recent_.back() = {.t = t, .good = true};
    }
  }

  /// Returns the comb of the latest edges if the clock should be set by it: the last edge lies on
  /// it and is not good, and it is not the clock's own comb.
  /// @param noise_s Standard deviation of an edge as observed so far.
  /// @param period_s Period of the clock.
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
