/// @file
/// Stability margins of the control loops of an orientation manoeuvre, drawn as an SVG page.

#pragma once

#include <array>
#include <string>

#include "pipelines/ground_model/flights/channel_margins.h"

namespace spindrift {

/// Returns an SVG with a row per channel: gain and phase over frequency, and the poles of the
/// closed loop for bodies and gains other than the designed ones.
std::string loop_plot(const std::string& spacecraft_id,
                      const std::array<ChannelMargins, 3>& channels);

}  // namespace spindrift
