/// @file
/// Dispersion of the runs of a scenario: [[dispersions]].

#pragma once

#include <cstdint>

#include "pipelines/core/expected.h"
#include "services/mission/document.h"

namespace spindrift {

/// Adds the problems that the schema cannot detect: keys that hold no number.
void check_dispersions(TomlDocument& document);

/// Returns the scenario of one run. Its seed is larger by `run`, and the dispersed numbers, each
/// element of an array by itself, are drawn from that seed. It does not depend on other runs.
/// @param document A scenario without problems. @param run Not negative.
/// @return A scenario that has problems where a draw is not allowed; errors of scenario_schema.
Expected<TomlDocument> dispersed(const TomlDocument& document, std::int64_t run);

}  // namespace spindrift
