/// @file
/// Reordering of pulses and frames by telemetry time.

#pragma once

#include <chrono>
#include <cstddef>

#include "pipelines/spin/types/coded_frame.h"
#include "pipelines/spin/types/pulse.h"
#include "pipelines/time/reorder_window.h"

namespace spindrift {

/// Returns how long, in telemetry time, a sample waits for earlier ones: a second for a pulse, two
/// and a half turns for a frame, which is sent once a turn. A frame without a period is taken to be
/// of the slowest body.
std::chrono::nanoseconds reorder_horizon(const Pulse& pulse);
std::chrono::nanoseconds reorder_horizon(const CodedFrame& frame);

/// All channels are of one kind, since one clock stamps them.
constexpr std::size_t kind_in_order(const Pulse& /*pulse*/) { return 0; }
constexpr std::size_t kind_in_order(const CodedFrame& /*frame*/) { return 0; }

extern template class BasicReorderWindow<Pulse>;
extern template class BasicReorderWindow<CodedFrame>;

using ReorderWindow = BasicReorderWindow<Pulse>;
using FrameReorderWindow = BasicReorderWindow<CodedFrame>;

}  // namespace spindrift
