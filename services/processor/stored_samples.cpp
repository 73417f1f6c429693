#include "services/processor/stored_samples.h"

#include <algorithm>
#include <iterator>

namespace spindrift {

StoredSamples::StoredSamples(const StoredPass& stored) {
  std::transform(stored.pulses.begin(), stored.pulses.end(), std::back_inserter(pulses_),
                 [](const StoredPulse& pulse) { return pulse.pulse; });
  std::transform(stored.frames.begin(), stored.frames.end(), std::back_inserter(frame_times_),
                 [](const StoredFrame& frame) { return frame.frame.t; });
  std::sort(pulses_.begin(), pulses_.end());
  std::sort(frame_times_.begin(), frame_times_.end());
}

bool StoredSamples::hold(const Pulse& pulse) const {
  return std::binary_search(pulses_.begin(), pulses_.end(), pulse);
}

bool StoredSamples::hold(const CodedFrame& frame) const {
  return std::binary_search(frame_times_.begin(), frame_times_.end(), frame.t);
}

}  // namespace spindrift
