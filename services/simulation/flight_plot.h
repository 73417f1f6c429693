/// @file
/// How a simulated body turned, and its wheels with it, as a page for people.

#pragma once

#include <string>

#include "services/simulation/scenario.h"
#include "services/simulation/simulated_pass.h"

namespace spindrift {

/// SVG: attitude seen from the start, rates and, where wheels turn it, their momenta and speeds
/// with what they were told: figures 7 to 12 of Zhang 2019.
/// @param pass Of a three-axis spacecraft.
std::string flight_plot(const Scenario& scenario, const SimulatedPass& pass);

}  // namespace spindrift
