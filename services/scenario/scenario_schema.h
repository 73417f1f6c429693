/// @file
/// The rules of a scenario file.

#pragma once

#include "pipelines/core/expected.h"
#include "services/mission/spacecraft_kind.h"
#include "services/toml_schema/schema.h"

namespace spindrift {

/// schemas/scenario.schema.toml or schemas/separation.schema.toml with the tables of the mission
/// file that a scenario has too, as the program was built with them.
/// @return as parse_schema; never in a program that was tested.
Expected<TableRule> scenario_schema(SpacecraftKind kind);

}  // namespace spindrift
