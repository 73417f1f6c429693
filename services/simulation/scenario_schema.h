/// @file
/// Schemas of scenario files.

#pragma once

#include "pipelines/core/expected.h"
#include "services/mission/schema.h"

namespace spindrift {

/// Kind of a scenario, by spacecraft.kind and, for a three-axis spacecraft, attitude.model.
enum class ScenarioKind { Spin, Separation, Tumbling, Orientation, Rescue };

/// Returns schemas/scenario.schema.toml, or schemas/three-axis.schema.toml with that of its model,
/// with the tables that a scenario shares with the mission file. All are built into the program.
/// @return Errors of parse_schema, which no tested program has.
Expected<TableRule> scenario_schema(ScenarioKind kind);

}  // namespace spindrift
