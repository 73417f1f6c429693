/// @file
/// Where one pass ends and the next begins.

#pragma once

#include <chrono>
#include <cstddef>
#include <optional>

#include "pipelines/time/tai_time.h"
#include "pipelines/time/time_jump.h"

namespace spindrift {

/// Looks at the samples of a spacecraft in the order of their arrival.
class PassWatch {
 public:
  /// Longer a silence does not last within a pass.
  static constexpr std::chrono::hours kLongestSilence{1};
  /// Fewer samples are no pass.
  static constexpr std::size_t kEnoughToAccept = TimeJump::kFewest;

  /// Within: not later than the pass has come, which says nothing of those from beyond. Onward: the
  /// pass goes on, and what came from beyond was wrong. Undecided: from beyond. NewPass: time has
  /// jumped there.
  /// A few stray samples before are no pass of their own: then what is accepted carries theirs on.
  enum class Verdict { Within, Onward, Undecided, NewPass };

  /// @param kind Of the sample, as kTelemetryKind.
  Verdict see(TaiTime t, std::size_t kind);

  /// Nothing comes any more: whether those from beyond are a new pass.
  bool ends_in_new_pass() const { return jump_.could_be() && within_ >= kEnoughToAccept; }

  /// The pass has come so far, without what came from beyond. Empty before its first sample.
  std::optional<TaiTime> reached() const { return reached_; }

 private:
  std::optional<TaiTime> reached_;
  std::size_t within_ = 0;  ///< Samples of the pass.
  std::size_t beyond_ = 0;  ///< Since the pass was carried on last.
  TimeJump jump_;           ///< To beyond.
};

}  // namespace spindrift
