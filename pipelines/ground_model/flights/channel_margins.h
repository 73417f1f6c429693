/// @file
/// How near the loops of an orientation's control are to swinging.

#pragma once

#include <array>

#include "pipelines/core/expected.h"
#include "pipelines/ground_model/control/loop_margins.h"
#include "pipelines/ground_model/flights/orientation_motion.h"

namespace spindrift {

/// Of the loop about one axis.
struct ChannelMargins {
  ChannelLoop designed;  ///< For the moments that the control takes for true; not sampled.
  ChannelLoop flown;     ///< Of the true body; sampled and late.
  LoopMargins designed_margins;
  LoopMargins flown_margins;
};

/// About X, Y and Z; products of inertia are left out.
/// @return as loop_margins.
Expected<std::array<ChannelMargins, 3>> channel_margins(const OrientationTruth& truth);

/// @return InvalidConfiguration where a loop as it is flown has no phase margin: it would swing.
Expected<void> check_margins(const OrientationTruth& truth);

}  // namespace spindrift
