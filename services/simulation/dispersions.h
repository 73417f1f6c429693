/// @file
/// How the runs of a scenario differ: [[dispersions]].

#pragma once

#include <cstdint>

#include "pipelines/core/expected.h"
#include "services/mission/document.h"

namespace spindrift {

/// Adds the problems that the schema cannot see: keys that hold no number.
void check_dispersions(TomlDocument& document);

/// The scenario of one run: of a seed larger by `run`, by which each dispersed number is drawn,
/// too; of an array each element by itself. It does not depend on other runs.
/// @param document In which no problem was found. @param run Not negative.
/// @return what has problems, too, where a draw is not allowed; InvalidConfiguration as
///         scenario_schema.
Expected<TomlDocument> dispersed(const TomlDocument& document, std::int64_t run);

}  // namespace spindrift
