/// @file
/// The status of a spacecraft in one line of a terminal.

#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "services/mission/mission.h"
#include "services/program/arrival_tally.h"
#include "services/publisher/health.h"

namespace spindrift {

/// "SPINNER 03:24:04Z age 0.2s rev 597 6.0/s sun 0/0 N 0/0 S -/4 batch OK 0.042deg": UTC and age of
/// the telemetry, revolutions, edges (or samples) per second, the age of each channel in s (`-`:
/// never received), the estimate in force with quality and sigma; where there is room also date and
/// axis. A three-axis spacecraft shows only the sensors received.
/// @param columns Largest number of characters; the least needed parts are dropped first.
std::string status_line(const Mission& mission, const SpacecraftHealth& health,
                        const TalliedArrivals& arrivals, std::optional<double> rate_hz,
                        std::size_t columns);

}  // namespace spindrift
