/// @file
/// How near the loops of an orientation's control are to swinging, as a page for people.

#pragma once

#include <array>
#include <optional>
#include <string>

#include "pipelines/core/expected.h"
#include "pipelines/ground_model/control/loop_margins.h"
#include "pipelines/ground_model/flights/orientation_motion.h"

namespace spindrift {

/// About X, Y and Z: as if it were not sampled, and as it is flown.
struct ChannelMargins {
  ChannelLoop continuous;
  ChannelLoop flown;
  LoopMargins continuous_margins;
  LoopMargins flown_margins;
};

/// @return as loop_margins.
Expected<std::array<ChannelMargins, 3>> channel_margins(const OrientationControl& control);

/// SVG: a row a channel, its gain and phase over the frequency and the poles of the closed loop for
/// bodies and gains other than those meant.
std::string loop_plot(const std::string& spacecraft_id,
                      const std::array<ChannelMargins, 3>& channels);

}  // namespace spindrift
