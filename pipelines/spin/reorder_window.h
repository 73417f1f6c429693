/// @file
/// Telemetry time orders the pulses, whatever order they arrive in.

#pragma once

#include <chrono>
#include <deque>
#include <set>
#include <vector>

#include "pipelines/spin/pulse.h"

namespace spindrift {

/// Holds pulses until nothing earlier is to be expected: until one arrives that is `kReorder` of
/// telemetry time younger.
class ReorderWindow {
 public:
  static constexpr std::chrono::nanoseconds kReorder{std::chrono::seconds{1}};
  /// How long a released pulse is known again: longer than any pulse waits to be settled.
  static constexpr std::chrono::nanoseconds kRemembered{std::chrono::minutes{10}};

  enum class Verdict { Held, Duplicate, Late };

  /// Takes a pulse in. Duplicate: it is held, or was released within kRemembered. Late: what comes
  /// after it has been released already.
  Verdict add(const Pulse& pulse);

  /// Pulses whose turn has come, in order of time and channel.
  std::vector<Pulse> release();
  /// All that are held: the pass has ended.
  std::vector<Pulse> release_all();

 private:
  void remember(const Pulse& pulse);

  std::set<Pulse> held_;
  std::deque<Pulse> released_;  ///< In order; those remembered, at least the last one.
};

}  // namespace spindrift
