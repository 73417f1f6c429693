/// @file
/// What a person should know of an instant of a coming pass, in words.

#pragma once

#include <string>
#include <vector>

#include "pipelines/spin/planning/pass_geometry.h"
#include "pipelines/spin/types/config.h"

namespace spindrift {

/// As "north beam sees the Earth", one for each thing that holds; free of numbers that change from
/// one instant to the next, so that the same words hold for a while.
std::vector<std::string> conditions_of(const SpinConfig& config, const PassGeometry& geometry);

}  // namespace spindrift
