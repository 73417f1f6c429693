/// @file
/// The rules of a mission file.

#pragma once

#include "pipelines/core/expected.h"
#include "services/mission/schema.h"

namespace spindrift {

/// schemas/mission.schema.toml, as the program was built with it.
/// @return as parse_schema; never in a program that was tested.
Expected<TableRule> mission_schema();

}  // namespace spindrift
