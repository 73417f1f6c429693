/// @file
/// Edges of different channels that meet on an analog link spoil each other.

#pragma once

#include <array>
#include <chrono>
#include <deque>
#include <optional>
#include <vector>

#include "pipelines/spin/types/products.h"
#include "pipelines/spin/types/pulse.h"

namespace spindrift {

/// Holds each edge until none can come that is closer to it than the window.
class InterferenceWindow {
 public:
  /// @param interference_s Edges of different channels closer than this spoil each other; 0: none.
  explicit InterferenceWindow(double interference_s);

  struct Judged {
    Pulse pulse;
    std::optional<EdgeGap> spoilt_by;  ///< The gap to an edge that spoils it; empty: none does.
    friend bool operator==(const Judged&, const Judged&) = default;
  };
  /// @param pulse Not earlier than the previous pulse.
  /// @return Judged edges, in order of time.
  std::vector<Judged> push(const Pulse& pulse);
  /// Ends the pass and returns the held edges.
  std::vector<Judged> finish();

 private:
  void give_front(std::vector<Judged>& out);
  std::optional<EdgeGap> spoiling(TaiTime one, TaiTime later) const;

  std::chrono::nanoseconds window_;
  std::deque<Judged> held_;
  std::array<std::optional<TaiTime>, kPulseChannels> latest_;  ///< Latest edge by channel.
};

}  // namespace spindrift
