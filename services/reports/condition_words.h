/// @file
/// What holds in a coming pass as sentences for people.

#pragma once

#include <string>

#include "pipelines/spin/planning/pass_conditions.h"

namespace spindrift {

/// As "north beam sees the Earth".
std::string sentence_of(const PassCondition& condition);

}  // namespace spindrift
