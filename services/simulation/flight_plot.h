/// @file
/// Motion of a simulated body and its wheels, and the stability margins of its loops, as SVG pages.

#pragma once

#include <array>
#include <string>

#include "pipelines/ground_model/flights/channel_margins.h"
#include "services/simulation/scenario.h"
#include "services/simulation/simulated_pass.h"

namespace spindrift {

/// Returns an SVG: attitude relative to the start, rates and, where wheels turn the body, their
/// momenta and speeds with those commanded: figures 7 to 12 of Zhang 2019; where the body carries a
/// table of the field, the error of the attitude that it computes itself.
/// @param pass Pass of a three-axis spacecraft.
std::string flight_plot(const Scenario& scenario, const SimulatedPass& pass);

/// Returns an SVG with a row per channel: gain and phase over frequency, and the poles of the
/// closed loop for bodies and gains other than the designed ones.
std::string loop_plot(const std::string& spacecraft_id,
                      const std::array<ChannelMargins, 3>& channels);

}  // namespace spindrift
