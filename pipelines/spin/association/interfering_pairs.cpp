#include "pipelines/spin/association/interfering_pairs.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace spindrift {

std::vector<InterferingChannels> InterferingPairs::expect(const ExpectedPhases& phases, double turn,
                                                          double clock_sigma_turns, TaiTime t) {
  gaps_.fill(std::nullopt);
  std::vector<InterferingChannels> began;
  if (!(window_s_ > 0.0)) {
    return began;
  }
  for (std::size_t i = 0; i < kPulseChannels; ++i) {
    for (std::size_t j = i + 1; j < kPulseChannels; ++j) {
      const auto one = static_cast<PulseChannel>(i);
      const auto other = static_cast<PulseChannel>(j);
      const auto gap = phases.gap(one, other, turn, clock_sigma_turns);
      if (gap && gap->gap_s < gap->least_s) {
        gaps_.at(i) = gaps_.at(j) = gap;
        if (const InterferingChannels& channels = record(one, other, t);
            channels.revolutions == kFewestInterfering) {
          began.push_back(channels);
        }
      }
    }
  }
  return began;
}

const InterferingChannels& InterferingPairs::record(PulseChannel one, PulseChannel other,
                                                    TaiTime t) {
  auto known =
      std::find_if(interfering_.begin(), interfering_.end(),
                   [&](const InterferingChannels& c) { return c.one == one && c.other == other; });
  if (known == interfering_.end()) {
    known = interfering_.insert(known, {.one = one, .other = other, .first = t, .last = t});
  }
  known->last = t;
  ++known->revolutions;
  return *known;
}

double InterferingPairs::displacement_s() const { return window_s_ / std::sqrt(12.0); }

}  // namespace spindrift
