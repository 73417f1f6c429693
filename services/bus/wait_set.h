/// @file
/// Sleeping until a reader has something or the program stops.

#pragma once

#include <chrono>

#include "services/bus/participant.h"

namespace spindrift::bus {

class WaitSet {
 public:
  /// @return Unavailable when Cyclone refuses.
  static Expected<WaitSet> create(const Participant& participant);

  /// From now on `condition` (of a reader: `Reader::data()`) ends a wait for as long as it holds.
  Expected<void> attach(const Entity& condition);

  /// Waits for an attached condition, or `at_most`. @return false once stopped.
  Expected<bool> wait(std::chrono::nanoseconds at_most = std::chrono::nanoseconds::max()) const;

  /// Ends every wait, now and later. From any thread.
  void stop() const;

 private:
  WaitSet(Entity set, Entity guard) : set_{std::move(set)}, guard_{std::move(guard)} {}

  Entity set_;
  Entity guard_;
};

}  // namespace spindrift::bus
