#include "pipelines/spin/types/coded_frame.h"

#include <algorithm>
#include <cmath>

#include "pipelines/time/time_span.h"

namespace spindrift {

std::vector<Pulse> edges_of(const CodedFrame& frame) {
  std::vector<Pulse> edges{{.t = frame.t, .channel = PulseChannel::Sun1}};
  const double period_s = frame.period_s.value_or(0.0);
  for (std::size_t i = 0; i < kPulseChannels; ++i) {
    const auto channel = static_cast<PulseChannel>(i);
    const auto& delay_s = frame.delay_s.at(i);
    if (!delay_s || channel == PulseChannel::Sun1) {
      continue;
    }
    const bool is_plain = *delay_s >= 0.0 && *delay_s <= kLongestDelay_periods * period_s;
    const double turns = period_s > 0.0 && !is_plain ? std::floor(*delay_s / period_s) : 0.0;
    edges.push_back({.t = later_by_s(frame.t, *delay_s - turns * period_s), .channel = channel});
  }
  std::sort(edges.begin(), edges.end());
  return edges;
}

}  // namespace spindrift
