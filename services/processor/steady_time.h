/// @file
/// How far a stream has come in telemetry time, whatever single samples of it say.

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

/// Further apart two streams do not agree. The pipelines do not take it for disorder either.
inline constexpr std::chrono::nanoseconds kApart = ReorderWindow::kFarAhead;

constexpr bool are_apart(TaiTime a, TaiTime b, std::chrono::nanoseconds limit = kApart) {
  return span_between(std::min(a, b), std::max(a, b)) > limit;
}

/// Eight samples that go on from one another say where it is; later ones carry it on, and eight in
/// a row elsewhere move it there. One that is sent again says nothing.
class SteadyTime {
 public:
  /// @return Whether it goes on from the one before, or begins elsewhere.
  bool see(TaiTime t) {
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

  /// Empty: nobody can tell yet.
  std::optional<TaiTime> time() const { return time_; }
  /// Of the newest sample.
  TaiTime recent() const { return recent_; }
  /// Whether the newest samples are enough to be believed, wherever they are.
  bool goes_on() const { return in_a_row_ >= PassWatch::kEnoughToAccept; }

 private:
  std::optional<TaiTime> time_;
  TaiTime recent_{};
  std::size_t in_a_row_ = 0;
};

}  // namespace spindrift
