/// @file
/// Converts a mission file to the configuration of the three-axis pipeline.

#pragma once

#include "pipelines/three_axis/config.h"
#include "services/mission/document.h"
#include "services/mission/scalar.h"

namespace spindrift {

/// Adds the problems of fields of view that the schema cannot detect.
void check_fields_of_view(TomlDocument& document);

/// @param values Values of a mission file without problems.
ThreeAxisConfig three_axis_config(const TomlValues& values);

}  // namespace spindrift
