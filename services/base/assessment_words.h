/// @file
/// The assessment of an estimate, quality and reasons, as a sentence for people.

#pragma once

#include <string>

#include "pipelines/core/assessment.h"

namespace spindrift {

/// Returns for example "OK, 600 revolutions, 2 edges gated", the name of the quality first.
std::string sentence_of(const Assessment& assessment);

}  // namespace spindrift
