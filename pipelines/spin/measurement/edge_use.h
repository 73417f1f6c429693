/// @file
/// Decides which edges of a revolution are accepted.

#pragma once

#include <optional>
#include <vector>

#include "pipelines/spin/types/config.h"
#include "pipelines/spin/types/products.h"
#include "pipelines/spin/types/revolution.h"

namespace spindrift {

/// Holds the test result of one measurement of the revolution.
struct Verdict {
  SpinQuantity quantity;
  std::optional<Rejection> rejected_by;  ///< Empty if accepted.
};

/// Returns whether the spacecraft has the sensor of the channel.
bool has_sensor(const SpinConfig& config, PulseChannel channel);

/// Accepts an edge unless it lies off its channel's phase, the mission has no such sensor, no orbit
/// covers it, or every measurement that it went into failed its own test. An edge without a partner
/// is accepted, because the sequential estimator uses it.
std::vector<PulseUse> edge_uses(const SpinConfig& config, const Revolution& revolution,
                                const std::vector<Verdict>& verdicts);

}  // namespace spindrift
