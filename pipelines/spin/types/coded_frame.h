/// @file
/// Coded telemetry: intervals that a spin-stabilised satellite times on board, one frame a turn.
///
/// Adding a period to the end of a chord that precedes its beginning was rejected: the edge would
/// be a turn late. It is in the next frame, and association joins the two.

#pragma once

#include <array>
#include <compare>
#include <optional>
#include <vector>

#include "pipelines/core/sender.h"
#include "pipelines/spin/types/pulse.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

/// Longest interval behind sun1 that is taken as it is: its edge is of the revolution that begins
/// with sun1, or of the next one.
inline constexpr double kLongestDelay_periods = 2.0;

/// The six leading edges as intervals measured on board. Empty: not received.
struct CodedFrame {
  TaiTime t;                       ///< Time of its sun1 edge.
  std::optional<double> period_s;  ///< T12, interval between this sun1 and its neighbour.
  /// Delays behind sun1 by channel, up to two periods; that of sun1 itself is empty.
  std::array<std::optional<double>, kPulseChannels> delay_s;
  Sender sender = Sender::First;

  // Frames of one instant are equal; Contested decides which of them counts.
  friend auto operator<=>(const CodedFrame& a, const CodedFrame& b) { return a.t <=> b.t; }
  friend bool operator==(const CodedFrame& a, const CodedFrame& b) { return a.t == b.t; }
};

/// Tells whether two frames agree but for rounding. A value that only one has is a difference.
bool say_the_same(const CodedFrame& a, const CodedFrame& b);

/// Returns the edges in order of time: sun1, and the others behind it. An on-board counter that
/// begins anew with each sun1 puts the end of a chord that straddles sun1 into the next frame.
/// Delays that no counter gives, below 0 or above two periods, are taken modulo the period; without
/// a positive period all are taken as they are.
std::vector<Pulse> edges_of(const CodedFrame& frame);

}  // namespace spindrift
