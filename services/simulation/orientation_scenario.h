/// @file
/// The scenario of a satellite that turns to an attitude by its wheels.

#pragma once

#include "pipelines/ground_model/flights/three_axis_flights.h"
#include "pipelines/time/tai_time.h"
#include "services/mission/document.h"
#include "services/mission/scalar.h"

namespace spindrift {

/// Adds the problems that the schema cannot detect.
void check_orientation_scenario(TomlDocument& document);

/// @param values Values of a scenario without problems.
OrientationScenario orientation_scenario(const TomlValues& values, TaiTime start);

}  // namespace spindrift
