/// @file
/// Where one pass ends and the next begins.

#pragma once

#include <chrono>
#include <cstddef>
#include <optional>

#include "pipelines/spin/telemetry_order/reorder_window.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

/// Looks at the samples of a spacecraft in the order of their arrival.
class PassWatch {
 public:
  /// Longer a silence does not last within a pass.
  static constexpr std::chrono::hours kLongestSilence{1};
  /// So many samples from beyond it are accepted, when none between them carries the pass on.
  static constexpr std::size_t kEnoughToAccept = ReorderWindow::kEnoughToAccept;

  /// Within: not later than the pass has come, which says nothing of those from beyond. Onward: the
  /// pass goes on, and what came from beyond was wrong. Undecided: from beyond. NewPass: accepted.
  /// A few stray samples before are no pass of their own: then what is accepted carries theirs on.
  enum class Verdict { Within, Onward, Undecided, NewPass };

  Verdict see(TaiTime t);

  /// The pass has come so far, without what came from beyond. Empty before its first sample.
  std::optional<TaiTime> reached() const { return reached_; }

 private:
  std::optional<TaiTime> reached_;
  std::size_t within_ = 0;  ///< Samples of the pass.
  std::size_t beyond_ = 0;
};

}  // namespace spindrift
