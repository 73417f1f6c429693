/// @file
/// The telemetry time that a stream has reached, robust against single samples with a wrong time.

#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <optional>

#include "pipelines/spin/telemetry_order/pulse_reorder_window.h"
#include "pipelines/time/tai_time.h"
#include "pipelines/time/time_span.h"
#include "services/processor/pass_watch.h"

namespace spindrift {

/// Two streams whose times differ by more than this disagree. It equals the limit from which the
/// pipelines no longer take a difference for disorder.
inline constexpr std::chrono::nanoseconds kApart = ReorderWindow::kFarAhead;

constexpr bool are_apart(TaiTime a, TaiTime b, std::chrono::nanoseconds limit = kApart) {
  return span_between(std::min(a, b), std::max(a, b)) > limit;
}

/// Tracks the time of a stream. Eight consecutive samples establish the time; later samples carry
/// it on, and eight consecutive samples elsewhere move it there. A repeated sample is ignored.
class SteadyTime {
 public:
  /// @return Whether the sample is later than the one before it, or starts a new sequence.
  bool advance_to(TaiTime t) {
    const bool begins = in_a_row_ == 0 || are_apart(recent_, t);
    if (!begins && t <= recent_) {
      return false;
    }
    recent_ = t;
    in_a_row_ = begins ? 1 : in_a_row_ + 1;
    if (goes_on() || (time_ && !are_apart(*time_, t))) {
      time_ = goes_on() ? t : std::max(*time_, t);
    }
    return true;
  }

  /// Returns the time of the stream; empty until enough samples have come.
  std::optional<TaiTime> time() const { return time_; }
  /// Returns the time of the newest sample that is not a repetition.
  TaiTime recent() const { return recent_; }
  /// Returns whether the newest samples are enough to be believed, whatever their time.
  bool goes_on() const { return in_a_row_ >= PassWatch::kEnoughToAccept; }

 private:
  std::optional<TaiTime> time_;
  TaiTime recent_{};
  std::size_t in_a_row_ = 0;
};

}  // namespace spindrift
