/// @file
/// Telemetry time orders the pulses, whatever order they arrive in.

#pragma once

#include <chrono>
#include <cstddef>
#include <deque>
#include <set>
#include <vector>

#include "pipelines/spin/pulse.h"

namespace spindrift {

/// Holds pulses until nothing earlier is to be expected: until one arrives that is `kReorder` of
/// telemetry time younger.
///
/// A pulse far ahead of the others moves nothing by itself, since a sender with a bad clock would
/// make all true pulses late. When several in a row say so, time has really jumped: the pass goes
/// on after a silence.
class ReorderWindow {
 public:
  static constexpr std::chrono::nanoseconds kReorder{std::chrono::seconds{1}};
  /// Further than this ahead of all that came before is far.
  static constexpr std::chrono::nanoseconds kFarAhead{std::chrono::minutes{1}};
  /// So many far ones, with none between that is not, are believed.
  static constexpr std::size_t kBelieved = 8;
  /// How long a released pulse is known again: longer than any pulse waits to be settled.
  static constexpr std::chrono::nanoseconds kRemembered{std::chrono::minutes{10}};

  /// No more than this are kept waiting to be believed.
  static constexpr std::size_t kMostFarAhead = 4096;

  enum class Verdict { Held, Duplicate, Late, OutOfTime };

  /// Takes a pulse in. Duplicate: it is held, or was released within kRemembered. Late: what comes
  /// after it has been released already. OutOfTime: far ahead, as too many before it.
  Verdict add(const Pulse& pulse);

  /// Pulses whose turn has come, in order of time and channel.
  std::vector<Pulse> release();

  struct Rest {
    std::vector<Pulse> in_time;      ///< In order of time and channel.
    std::vector<Pulse> out_of_time;  ///< Far ahead, and too few to be believed.
  };
  /// All that are held: the pass has ended.
  Rest release_all();

 private:
  bool is_far_ahead(const Pulse& pulse) const;
  void believe();
  void remember(const Pulse& pulse);

  std::set<Pulse> held_;
  std::set<Pulse> far_ahead_;
  std::size_t far_in_a_row_ = 0;
  std::vector<Pulse> due_;      ///< Before a jump that was believed.
  std::deque<Pulse> released_;  ///< In order; those remembered, at least the last one.
};

}  // namespace spindrift
