/// @file
/// What a service had stored of a pass before it was restarted.

#pragma once

#include <vector>

#include "services/archive/stored_pass.h"

namespace spindrift {

/// A front-end sends its last minutes again: that tells nothing of the pass, and is no news to it.
class StoredSamples {
 public:
  explicit StoredSamples(const StoredPass& stored);

  bool hold(const Pulse& pulse) const;
  bool hold(const CodedFrame& frame) const;

 private:
  std::vector<Pulse> pulses_;         ///< In order.
  std::vector<TaiTime> frame_times_;  ///< In order.
};

}  // namespace spindrift
