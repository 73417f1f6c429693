/// @file
/// Products of a revolution other than an axis: itself, its measurements, the use of its edges.

#pragma once

#include <vector>

#include "pipelines/spin/measurement/measurement.h"
#include "pipelines/spin/types/config.h"
#include "pipelines/spin/types/products.h"
#include "pipelines/spin/types/revolution.h"

namespace spindrift {

/// Returns these products in that order; the revolution itself only if its sun1 is good.
/// @param measured Measurements after screening.
std::vector<SpinProduct> revolution_products(const SpinConfig& config, const Revolution& revolution,
                                             const RevolutionMeasurements& measured);

}  // namespace spindrift
