/// @file
/// Errors with which a command ends.

#pragma once

#include <string>
#include <utility>

#include "pipelines/core/expected.h"

namespace spindrift {

/// Returns the error for a bad command line or input.
inline Unexpected refused(std::string message) {
  return Unexpected{{ErrorCode::InvalidConfiguration, std::move(message)}};
}

/// When both operations failed, the error has the first one's code and both messages.
inline Expected<void> outcome_of(const Expected<void>& run, const Expected<void>& closing) {
  if (!run && !closing) {
    return Unexpected{{run.error().code, run.error().message + "\n" + closing.error().message}};
  }
  return run ? closing : run;
}

}  // namespace spindrift
