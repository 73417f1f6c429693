/// @file
/// The order of telemetry time of pulses and frames.

#pragma once

#include <chrono>
#include <cstddef>

#include "pipelines/spin/types/coded_frame.h"
#include "pipelines/spin/types/pulse.h"
#include "pipelines/time/reorder_window.h"

namespace spindrift {

/// How much of telemetry time is waited for what precedes a sample: a second for a pulse, and two
/// and a half turns for a frame, which is sent once a turn; of the slowest body where it does not
/// say how long those are.
std::chrono::nanoseconds reorder_horizon(const Pulse& pulse);
std::chrono::nanoseconds reorder_horizon(const CodedFrame& frame);

/// One clock stamps all channels.
constexpr std::size_t kind_in_order(const Pulse& /*pulse*/) { return 0; }
constexpr std::size_t kind_in_order(const CodedFrame& /*frame*/) { return 0; }

extern template class BasicReorderWindow<Pulse>;
extern template class BasicReorderWindow<CodedFrame>;

using ReorderWindow = BasicReorderWindow<Pulse>;
using FrameReorderWindow = BasicReorderWindow<CodedFrame>;

}  // namespace spindrift
