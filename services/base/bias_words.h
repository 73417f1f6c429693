/// @file
/// The biases of the sensors of a spinner in words.

#pragma once

#include <string>

#include "pipelines/spin/types/sensor_biases.h"

namespace spindrift {

/// That the edges leave a direction of the biases open.
/// @param direction Those that take part in it.
std::string undetermined_sentence(const BiasSet& direction);

}  // namespace spindrift
