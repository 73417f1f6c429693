#include "pipelines/spin/coded_frame.h"

#include <algorithm>
#include <cmath>

#include "pipelines/spin/time_span.h"

namespace spindrift {

std::vector<Pulse> edges_of(const CodedFrame& frame) {
  std::vector<Pulse> edges{{.t = frame.t, .channel = PulseChannel::Sun1}};
  for (std::size_t channel = 0; channel < kPulseChannels; ++channel) {
    const auto& delay_s = frame.delay_s.at(channel);
    if (!delay_s || channel == index_of(PulseChannel::Sun1)) {
      continue;
    }
    const double turn_s = frame.period_s.value_or(0.0);
    const double behind_s =
        turn_s > 0.0 ? *delay_s - turn_s * std::floor(*delay_s / turn_s) : *delay_s;
    edges.push_back(
        {.t = later_by_s(frame.t, behind_s), .channel = static_cast<PulseChannel>(channel)});
  }
  std::sort(edges.begin(), edges.end());
  return edges;
}

}  // namespace spindrift
