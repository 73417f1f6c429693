/// @file
/// Telemetry time orders the samples, whatever order they arrive in.

#pragma once

#include <chrono>
#include <cstddef>
#include <deque>
#include <set>
#include <vector>

#include "pipelines/spin/types/coded_frame.h"
#include "pipelines/spin/types/pulse.h"

namespace spindrift {

/// How much of telemetry time is waited for what precedes a sample: a second for a pulse, and two
/// and a half turns for a frame, which is sent once a turn; of the slowest body where it does not
/// say how long those are.
std::chrono::nanoseconds reorder_horizon(const Pulse& pulse);
std::chrono::nanoseconds reorder_horizon(const CodedFrame& frame);

/// Holds samples until nothing earlier is to be expected: until one arrives that is the sample's
/// horizon of telemetry time younger.
///
/// One sample far ahead of the others does not advance time, since a sender with a bad clock would
/// make all true ones late; several in a row do: the pass continues after a silence. Likewise a few
/// samples far before all others are left out.
/// @tparam Sample Totally ordered, first by its time `t`.
template <class Sample>
class BasicReorderWindow {
 public:
  /// Further than this ahead of all that came before is far.
  static constexpr std::chrono::nanoseconds kFarAhead{std::chrono::minutes{1}};
  /// So many far ones in a row are accepted.
  static constexpr std::size_t kEnoughToAccept = 8;
  /// How long a released sample is known again: longer than any waits to be settled.
  static constexpr std::chrono::nanoseconds kRemembered{std::chrono::minutes{10}};

  /// No more than this are kept waiting to be accepted.
  static constexpr std::size_t kMostFarAhead = 4096;

  enum class Verdict { Held, Duplicate, Late, OutOfTime };

  /// Takes a sample in. Duplicate: it is held, or was released within kRemembered. Late: what comes
  /// after it has been released already. OutOfTime: far ahead, as too many before it.
  Verdict add(const Sample& sample);

  /// Samples whose turn has come, in order of time and channel.
  std::vector<Sample> release();

  /// The stream has fallen silent: all that are held in time, as if younger samples had come. Those
  /// far ahead stay set aside. While nothing is accepted yet and too few are in time, none: nobody
  /// can tell whose clock is right.
  std::vector<Sample> fall_silent();

  struct Rest {
    std::vector<Sample> in_time;      ///< In order of time and channel.
    std::vector<Sample> out_of_time;  ///< Far ahead or far before, and too few to be accepted.
  };
  /// All that are held: the pass has ended.
  Rest release_all();

 private:
  bool is_far_ahead(const Sample& sample) const;
  void accept_jump();
  bool set_aside_early();
  typename std::set<Sample>::const_iterator end_in_time() const;
  void remember(const Sample& sample);

  std::set<Sample> held_;
  std::set<Sample> far_ahead_;
  std::size_t far_in_a_row_ = 0;
  std::vector<Sample> early_;    ///< Too few, and far before the first accepted ones.
  std::vector<Sample> due_;      ///< Before a jump that was accepted.
  std::deque<Sample> released_;  ///< In order; those remembered, at least the last one.
};

extern template class BasicReorderWindow<Pulse>;
extern template class BasicReorderWindow<CodedFrame>;

using ReorderWindow = BasicReorderWindow<Pulse>;
using FrameReorderWindow = BasicReorderWindow<CodedFrame>;

}  // namespace spindrift
