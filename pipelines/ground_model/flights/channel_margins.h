/// @file
/// Stability margins of the control loops of an orientation manoeuvre.

#pragma once

#include <array>

#include "pipelines/core/expected.h"
#include "pipelines/ground_model/control/loop_margins.h"
#include "pipelines/ground_model/flights/orientation_motion.h"

namespace spindrift {

/// Margins of the loop about one axis.
struct ChannelMargins {
  ChannelLoop designed;  ///< Loop with the moments that the control assumes; not sampled.
  ChannelLoop flown;     ///< Loop of the true body; sampled and late.
  LoopMargins designed_margins;
  LoopMargins flown_margins;
};

/// Returns the margins about X, Y and Z; products of inertia are neglected.
/// @return Errors of loop_margins.
Expected<std::array<ChannelMargins, 3>> channel_margins(const OrientationTruth& truth);

/// @return InvalidConfiguration where a flown loop has no phase margin and would be unstable.
Expected<void> check_margins(const OrientationTruth& truth);

}  // namespace spindrift
