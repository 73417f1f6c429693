/// @file
/// What a revolution gives besides an axis: itself, its measurements, what became of its edges.

#pragma once

#include <vector>

#include "pipelines/spin/measurement/measurement.h"
#include "pipelines/spin/types/config.h"
#include "pipelines/spin/types/products.h"
#include "pipelines/spin/types/revolution.h"

namespace spindrift {

/// In that order; the revolution only where its sun1 is good.
/// @param measured After screening.
std::vector<SpinProduct> revolution_products(const SpinConfig& config, const Revolution& revolution,
                                             const RevolutionMeasurements& measured);

}  // namespace spindrift
