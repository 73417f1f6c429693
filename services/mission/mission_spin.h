/// @file
/// The [spin] of a mission file as the configuration of the spin pipeline.

#pragma once

#include "pipelines/spin/types/config.h"
#include "services/mission/scalar.h"

namespace spindrift {

/// `values` are those of a mission file of kind spin in which no problem was found.
SpinConfig spin_config(const TomlValues& values);

}  // namespace spindrift
