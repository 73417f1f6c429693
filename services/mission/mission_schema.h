/// @file
/// The rules of a mission file.

#pragma once

#include "pipelines/core/expected.h"
#include "services/mission/schema.h"

namespace spindrift {

/// Returns schemas/mission.schema.toml as embedded at build time.
/// @return The errors of parse_schema, which cannot occur in a tested program.
Expected<TableRule> mission_schema();

}  // namespace spindrift
