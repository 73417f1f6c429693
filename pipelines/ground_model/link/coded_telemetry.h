/// @file
/// Telemetry of a spacecraft that times its own pulses: one coded frame per revolution.

#pragma once

#include <vector>

#include "pipelines/ground_model/link/pulse_link.h"
#include "pipelines/spin/types/coded_frame.h"

namespace spindrift {

/// Simulates the on-board counter: each sun1 edge opens a frame, the first edge of every other
/// channel before the next sun1 gives its delay, and the time since the last sun1 is the period
/// (empty in the first frame). Intervals are rounded to multiples of `resolution_s` and to
/// nanoseconds, delays are taken modulo the period. The counter stops at `kLongestPeriod_s`: longer
/// intervals, and periods that round to zero, are empty. Edges before the first sun1 are left out.
///
/// The counter goes on through a silence of the link, which swallows each frame with an edge in it.
///
/// @param resolution_s Positive.
std::vector<CodedFrame> coded_telemetry(const ReceivedPass& pass, double resolution_s);

}  // namespace spindrift
