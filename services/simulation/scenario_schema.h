/// @file
/// The rules of a scenario file.

#pragma once

#include "pipelines/core/expected.h"
#include "services/mission/schema.h"

namespace spindrift {

/// By spacecraft.kind, and of a three-axis one by attitude.model.
enum class ScenarioKind { Spin, Separation, Tumbling, Orientation };

/// schemas/scenario.schema.toml; or schemas/three-axis.schema.toml and that of its model; with the
/// tables of the mission file that a scenario has too, as the program was built with them.
/// @return as parse_schema; never in a program that was tested.
Expected<TableRule> scenario_schema(ScenarioKind kind);

}  // namespace spindrift
