/// @file
/// What a revolution gives besides an axis: itself, its measurements, what became of its edges.

#pragma once

#include <vector>

#include "pipelines/spin/config.h"
#include "pipelines/spin/measurement.h"
#include "pipelines/spin/products.h"
#include "pipelines/spin/revolution.h"

namespace spindrift {

/// In that order; the revolution only where its sun1 is good.
/// @param measured After screening.
std::vector<SpinProduct> revolution_products(const SpinConfig& config, const Revolution& revolution,
                                             const RevolutionMeasurements& measured);

}  // namespace spindrift
