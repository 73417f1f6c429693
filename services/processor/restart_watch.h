/// @file
/// Whether what arrives after a restart belongs to the pass before it.

#pragma once

#include <chrono>
#include <cstddef>
#include <vector>

#include "services/archive/stored_pass.h"

namespace spindrift {

/// Looks at samples until one tells. Those that are stored already tell nothing: a front-end sends
/// its last minutes again.
class RestartWatch {
 public:
  /// Longer a silence does not last within a pass.
  static constexpr std::chrono::hours kLongestSilence{1};
  /// So many samples from beyond it are believed, if none comes between that is not.
  static constexpr std::size_t kBelieved = 8;

  enum class Verdict { Stored, SamePass, Undecided, NewPass };

  explicit RestartWatch(const StoredPass& stored);

  Verdict see(const Pulse& pulse);
  Verdict see(const CodedFrame& frame);

 private:
  Verdict see_new(TaiTime t);

  std::vector<Pulse> pulses_;         ///< In order.
  std::vector<TaiTime> frame_times_;  ///< In order.
  TaiTime same_pass_until_;
  std::size_t beyond_ = 0;
};

}  // namespace spindrift
