/// @file
/// Which axis a solution has taken among others, and what settled that.

#pragma once

#include <optional>

#include "pipelines/spin/batch/after_changepoint.h"
#include "pipelines/spin/types/products.h"

namespace spindrift {

/// @param of_pass What the pass has taken before.
AxisChoice axis_choice(const Solved& solved, const std::optional<AxisChoice>& of_pass);

}  // namespace spindrift
