/// @file
/// Conditions of a planned pass as sentences.

#pragma once

#include <string>

#include "pipelines/spin/planning/pass_conditions.h"

namespace spindrift {

/// Returns a sentence such as "north beam sees the Earth".
std::string sentence_of(const PassCondition& condition);

}  // namespace spindrift
