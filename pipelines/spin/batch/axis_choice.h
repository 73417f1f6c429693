/// @file
/// Records which of the competing axes a solution has taken and what settled the choice.

#pragma once

#include <optional>

#include "pipelines/spin/batch/after_changepoint.h"
#include "pipelines/spin/types/products.h"

namespace spindrift {

/// @param of_pass Earlier choice of the same pass, if any.
AxisChoice axis_choice(const Solved& solved, const std::optional<AxisChoice>& of_pass);

}  // namespace spindrift
