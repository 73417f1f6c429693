/// @file
/// A scenario played: what was received, and the truth about it.

#pragma once

#include <cstdint>

#include "pipelines/core/expected.h"
#include "pipelines/ground_model/pulse_link.h"
#include "services/scenario/scenario.h"

namespace spindrift {

struct SimulatedPass {
  ReceivedPass received;
  std::int64_t revolutions;
};

/// Shows its progress on a terminal.
/// @return InvalidConfiguration where the scenario's orbit does not allow it.
Expected<SimulatedPass> simulated_pass(const Scenario& scenario);

/// Received edges with that damage.
std::int64_t count_of(Damage damage, const SimulatedPass& pass);

}  // namespace spindrift
