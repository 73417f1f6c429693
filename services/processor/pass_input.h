/// @file
/// Samples on their way to the computing side of a run.

#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "pipelines/spin/types/coded_frame.h"
#include "pipelines/spin/types/pulse.h"

namespace spindrift {

/// What a pass is to work on next, in order of arrival: the pulses, then the frames.
struct PassInput {
  std::size_t spacecraft = 0;  ///< Index of its mission.
  std::string run_id;          ///< Another one than before: a new pass begins.
  std::vector<Pulse> pulses = {};
  std::vector<CodedFrame> frames = {};
};

inline std::size_t sample_count(const PassInput& input) {
  return input.pulses.size() + input.frames.size();
}

}  // namespace spindrift
