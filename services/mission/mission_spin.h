/// @file
/// Converts the [spin] of a mission file to the configuration of the spin pipeline.

#pragma once

#include "pipelines/spin/types/config.h"
#include "services/mission/scalar.h"

namespace spindrift {

/// @param values Values of a mission file of kind spin without problems.
SpinConfig spin_config(const TomlValues& values);

}  // namespace spindrift
