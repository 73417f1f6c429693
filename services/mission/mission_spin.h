/// @file
/// Converts the [spin] of a mission file to the configuration of the spin pipeline.

#pragma once

#include "pipelines/spin/types/config.h"
#include "services/mission/document.h"
#include "services/mission/scalar.h"

namespace spindrift {

/// @param values Values of a mission file of kind spin without problems.
SpinConfig spin_config(const TomlValues& values);

/// Adds as problems the biases of [spin.batch] that are to be estimated although the alignment says
/// that they are known exactly.
/// @param document Of kind spin and valid by the schema, its [calibration] too.
void check_estimated_biases(TomlDocument& document);

}  // namespace spindrift
