/// @file
/// Intervals of a coming pass in which a condition holds.

#pragma once

#include <vector>

#include "pipelines/spin/planning/pass_conditions.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

/// A condition and the interval in which it holds.
struct PassEvent {
  TaiTime from;
  TaiTime to;
  PassCondition condition;
};

class PassEvents {
 public:
  /// Adds the conditions that hold at a time later than the previous one.
  void add(TaiTime t, const std::vector<PassCondition>& conditions);

  /// Returns all events by beginning; conditions that still hold end with the last time.
  std::vector<PassEvent> finish();

 private:
  TaiTime last_;
  std::vector<PassEvent> open_;
  std::vector<PassEvent> closed_;
};

}  // namespace spindrift
