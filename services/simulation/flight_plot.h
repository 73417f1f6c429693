/// @file
/// Motion of a simulated body and its wheels, drawn as an SVG page.

#pragma once

#include <string>

#include "services/simulation/scenario.h"
#include "services/simulation/simulated_pass.h"

namespace spindrift {

/// Returns an SVG: attitude relative to the start, rates and, where wheels turn the body, their
/// momenta and speeds with those commanded: figures 7 to 12 of Zhang 2019.
/// @param pass Pass of a three-axis spacecraft.
std::string flight_plot(const Scenario& scenario, const SimulatedPass& pass);

}  // namespace spindrift
