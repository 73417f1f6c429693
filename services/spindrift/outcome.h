/// @file
/// How a command ended that had two things to end well.

#pragma once

#include "pipelines/core/expected.h"

namespace spindrift {

/// Both, when both failed: the first one's code, both messages.
inline Expected<void> outcome_of(const Expected<void>& run, const Expected<void>& closing) {
  if (!run && !closing) {
    return Unexpected{{run.error().code, run.error().message + "\n" + closing.error().message}};
  }
  return run ? closing : run;
}

}  // namespace spindrift
