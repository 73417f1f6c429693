/// @file
/// Edges of different channels that meet on an analog link spoil each other.

#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <deque>
#include <vector>

#include "pipelines/spin/types/pulse.h"

namespace spindrift {

/// Holds each edge until none can come that is closer to it than the window.
class InterferenceWindow {
 public:
  /// @param interference_s Edges of different channels closer than this spoil each other; 0: none.
  explicit InterferenceWindow(double interference_s);

  struct Judged {
    Pulse pulse;
    bool spoilt;
    friend bool operator==(const Judged&, const Judged&) = default;
  };
  /// @param pulse Not earlier than the previous pulse.
  /// @return Judged edges, in order of time.
  std::vector<Judged> push(const Pulse& pulse);
  /// Ends the pass and returns the held edges.
  std::vector<Judged> finish();

 private:
  void give_front(std::vector<Judged>& out);

  std::chrono::nanoseconds window_;
  std::deque<Judged> held_;
  std::array<std::size_t, kPulseChannels> held_of_{};  ///< Number of held edges by channel.
};

}  // namespace spindrift
