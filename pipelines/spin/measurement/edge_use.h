/// @file
/// What became of every edge of a revolution.

#pragma once

#include <optional>
#include <vector>

#include "pipelines/spin/types/config.h"
#include "pipelines/spin/types/products.h"
#include "pipelines/spin/types/revolution.h"

namespace spindrift {

/// What became of one measurement of the revolution.
struct Verdict {
  SpinQuantity quantity;
  std::optional<Rejection> rejected_by;  ///< Empty: accepted.
};

/// Whether the spacecraft has the sensor that the channel is of.
bool has_sensor(const SpinConfig& config, PulseChannel channel);

/// An edge is accepted unless it lies off its channel's phase, the mission has no such sensor, no
/// orbit covers it, or every measurement that it went into failed its own test. One whose partner
/// is missing is accepted: the sequential estimator uses it.
std::vector<PulseUse> edge_uses(const SpinConfig& config, const Revolution& revolution,
                                const std::vector<Verdict>& verdicts);

}  // namespace spindrift
