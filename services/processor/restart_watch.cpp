#include "services/processor/restart_watch.h"

#include <algorithm>
#include <iterator>

namespace spindrift {

RestartWatch::RestartWatch(const StoredPass& stored) : same_pass_until_{TaiTime::max()} {
  std::transform(stored.pulses.begin(), stored.pulses.end(), std::back_inserter(pulses_),
                 [](const StoredPulse& pulse) { return pulse.pulse; });
  std::transform(stored.frames.begin(), stored.frames.end(), std::back_inserter(frame_times_),
                 [](const StoredFrame& frame) { return frame.frame.t; });
  std::sort(pulses_.begin(), pulses_.end());
  std::sort(frame_times_.begin(), frame_times_.end());
  if (!pulses_.empty() || !frame_times_.empty()) {
    const TaiTime last_pulse = pulses_.empty() ? TaiTime::min() : pulses_.back().t;
    const TaiTime last_frame = frame_times_.empty() ? TaiTime::min() : frame_times_.back();
    same_pass_until_ = std::max(last_pulse, last_frame) + kLongestSilence;
  }
}

RestartWatch::Verdict RestartWatch::see(const Pulse& pulse) {
  const bool is_stored = std::binary_search(pulses_.begin(), pulses_.end(), pulse);
  return is_stored ? Verdict::Stored : see_new(pulse.t);
}

RestartWatch::Verdict RestartWatch::see(const CodedFrame& frame) {
  const bool is_stored = std::binary_search(frame_times_.begin(), frame_times_.end(), frame.t);
  return is_stored ? Verdict::Stored : see_new(frame.t);
}

RestartWatch::Verdict RestartWatch::see_new(TaiTime t) {
  if (t <= same_pass_until_) {
    return Verdict::SamePass;
  }
  return ++beyond_ < kBelieved ? Verdict::Undecided : Verdict::NewPass;
}

}  // namespace spindrift
