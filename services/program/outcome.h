/// @file
/// How a command ends that does not end well.

#pragma once

#include <string>
#include <utility>

#include "pipelines/core/expected.h"

namespace spindrift {

/// Of a bad command line or input.
inline Unexpected refused(std::string message) {
  return Unexpected{{ErrorCode::InvalidConfiguration, std::move(message)}};
}

/// Of two things that had to end well both, when both failed: the first one's code, both messages.
inline Expected<void> outcome_of(const Expected<void>& run, const Expected<void>& closing) {
  if (!run && !closing) {
    return Unexpected{{run.error().code, run.error().message + "\n" + closing.error().message}};
  }
  return run ? closing : run;
}

}  // namespace spindrift
