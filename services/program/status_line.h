/// @file
/// How a spacecraft is doing, in one line of a terminal.

#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "services/mission/mission.h"
#include "services/program/arrival_tally.h"
#include "services/publisher/health.h"

namespace spindrift {

/// "SPINNER 03:24:04Z age 0.2s rev 597 6.0/s sun 0/0 N 0/0 S -/4 batch OK 0.042deg": telemetry UTC,
/// how old it is, revolutions, edges (or samples) a second, the age of each channel in s (`-`: has
/// not come), the answer in force with quality and sigma; where there is room also date and axis.
/// Sensors are those of the mission, of a three-axis spacecraft those that have come.
/// @param rate_hz Edges or samples. @param columns At most so many characters: what is needed least
/// goes first.
std::string status_line(const Mission& mission, const SpacecraftHealth& health,
                        const TalliedArrivals& arrivals, std::optional<double> rate_hz,
                        std::size_t columns);

}  // namespace spindrift
