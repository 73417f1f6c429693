/// @file
/// Coded telemetry: what a spin-stabilised satellite times itself, one frame a revolution.

#pragma once

#include <array>
#include <compare>
#include <optional>
#include <vector>

#include "pipelines/core/sender.h"
#include "pipelines/spin/types/pulse.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

/// As far behind sun1 is an interval a plain time: an edge of the revolution that begins with sun1,
/// or of the one behind it.
inline constexpr double kLongestDelay_periods = 2.0;

/// The six leading edges as intervals measured on board. Empty: not received.
struct CodedFrame {
  TaiTime t;                       ///< Of its sun1 edge.
  std::optional<double> period_s;  ///< T12, between this sun1 and its neighbour.
  /// Behind sun1 by channel, up to two periods; that of sun1 itself is empty.
  std::array<std::optional<double>, kPulseChannels> delay_s;
  Sender sender = Sender::First;

  // Frames of one instant are one (Contested says which counts).
  friend auto operator<=>(const CodedFrame& a, const CodedFrame& b) { return a.t <=> b.t; }
  friend bool operator==(const CodedFrame& a, const CodedFrame& b) { return a.t == b.t; }
};

/// But for rounding. What one has and the other lacks is no rounding.
bool say_the_same(const CodedFrame& a, const CodedFrame& b);

/// Its edges in order of time: sun1, and the others behind it. A counter on board that begins anew
/// with each sun1 has the end of a chord that straddles sun1 in the frame behind that of its
/// beginning. Delays that no counter gives, below 0 or above two periods, are taken modulo the
/// period. Without a period, or with one that is none, all are taken as they are.
std::vector<Pulse> edges_of(const CodedFrame& frame);

}  // namespace spindrift
