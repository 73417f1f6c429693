/// @file
/// Detects where one pass ends and the next begins.

#pragma once

#include <chrono>
#include <cstddef>
#include <optional>

#include "pipelines/time/tai_time.h"
#include "pipelines/time/time_jump.h"

namespace spindrift {

/// Detects the end of a pass from the samples of a spacecraft in order of arrival.
class PassWatch {
 public:
  /// Within a pass no silence is longer than this.
  static constexpr std::chrono::hours kLongestSilence{1};
  /// Fewer samples than this are not a pass.
  static constexpr std::size_t kEnoughToAccept = TimeJump::kFewest;

  /// Judgement on a sample, where "beyond" means more than kLongestSilence later than the pass has
  /// reached. Within: not later than the pass has reached, which says nothing about samples from
  /// beyond. Onward: the pass goes on, and the samples from beyond were wrong. Undecided: the
  /// sample is from beyond. NewPass: time has jumped to the samples from beyond.
  /// When fewer than kEnoughToAccept samples came before a jump, they are no pass of their own and
  /// the jump only carries their pass on.
  enum class Verdict { Within, Onward, Undecided, NewPass };

  /// @param kind Kind of the sample as kTelemetryKind.
  Verdict judge(TaiTime t, std::size_t kind);

  /// Returns whether the samples from beyond are a new pass, given that no more samples come.
  bool ends_in_new_pass() const { return jump_.could_be() && within_ >= kEnoughToAccept; }

  /// Returns the time that the pass has reached, without samples from beyond. Empty at first.
  std::optional<TaiTime> reached() const { return reached_; }

 private:
  std::optional<TaiTime> reached_;
  std::size_t within_ = 0;  ///< Number of samples in the pass.
  std::size_t beyond_ = 0;  ///< Samples from beyond since the pass last went on.
  TimeJump jump_;           ///< Judges the samples from beyond.
};

}  // namespace spindrift
