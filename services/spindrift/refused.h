/// @file
/// What a command says of a bad command line or input.

#pragma once

#include <string>
#include <utility>

#include "pipelines/core/expected.h"

namespace spindrift {

inline Unexpected refused(std::string message) {
  return Unexpected{{ErrorCode::InvalidConfiguration, std::move(message)}};
}

}  // namespace spindrift
