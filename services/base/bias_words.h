/// @file
/// The sensor biases of a spinner in words.

#pragma once

#include <string>

#include "pipelines/spin/types/sensor_biases.h"

namespace spindrift {

/// States that the edges leave a direction of the biases undetermined.
/// @param direction Biases that take part in the direction.
std::string undetermined_sentence(const BiasSet& direction);

}  // namespace spindrift
