/// @file
/// Intervals of a coming pass in which a condition holds.

#pragma once

#include <vector>

#include "pipelines/spin/planning/pass_conditions.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

/// Something that holds for a while.
struct PassEvent {
  TaiTime from;
  TaiTime to;
  PassCondition condition;
};

class PassEvents {
 public:
  /// What holds at a time that is later than the one before.
  void add(TaiTime t, const std::vector<PassCondition>& conditions);

  /// All of them, by beginning; what holds still ends with the last time.
  std::vector<PassEvent> finish();

 private:
  TaiTime last_;
  std::vector<PassEvent> open_;
  std::vector<PassEvent> closed_;
};

}  // namespace spindrift
