/// @file
/// Waits until a reader has samples or the program stops.

#pragma once

#include <chrono>

#include "services/bus/participant.h"

namespace spindrift::bus {

class WaitSet {
 public:
  /// @return Unavailable when Cyclone refuses.
  static Expected<WaitSet> create(const Participant& participant);

  /// Makes `condition` (of a reader: `Reader::data()`) end waits while it holds.
  Expected<void> attach(const Entity& condition);

  /// Waits for an attached condition, for at most `at_most`. @return False once stopped.
  Expected<bool> wait(std::chrono::nanoseconds at_most = std::chrono::nanoseconds::max()) const;

  /// Ends the current wait and every later one. Safe to call from any thread.
  void stop() const;

 private:
  WaitSet(Entity set, Entity guard) : set_{std::move(set)}, guard_{std::move(guard)} {}

  Entity set_;
  Entity guard_;
};

}  // namespace spindrift::bus
