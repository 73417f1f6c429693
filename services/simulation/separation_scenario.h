/// @file
/// The scenario of a separation from the launcher.

#pragma once

#include "pipelines/ground_model/flights/three_axis_flights.h"
#include "pipelines/time/tai_time.h"
#include "services/mission/document.h"
#include "services/mission/scalar.h"

namespace spindrift {

/// Adds the problems that the schema cannot detect.
void check_separation_scenario(TomlDocument& document);

/// @param values Values of a scenario without problems. @param start Time of separation.
SeparationScenario separation_scenario(const TomlValues& values, TaiTime start);

}  // namespace spindrift
