/// @file
/// How near the loops of an orientation's control are to swinging, as a page for people.

#pragma once

#include <array>
#include <string>

#include "pipelines/ground_model/flights/channel_margins.h"

namespace spindrift {

/// SVG: a row a channel, its gain and phase over the frequency and the poles of the closed loop for
/// bodies and gains other than those meant.
std::string loop_plot(const std::string& spacecraft_id,
                      const std::array<ChannelMargins, 3>& channels);

}  // namespace spindrift
