#include "pipelines/spin/coded_frame.h"

#include <algorithm>
#include <cmath>

#include "pipelines/spin/time_span.h"

namespace spindrift {

namespace {

/// Behind sun1 modulo the period, which is positive.
std::optional<double> behind_sun1_s(const CodedFrame& frame, PulseChannel channel) {
  const auto& delay_s = frame.delay_s.at(index_of(channel));
  return delay_s
             ? std::optional{*delay_s - *frame.period_s * std::floor(*delay_s / *frame.period_s)}
             : std::nullopt;
}

/// Whether it is the end of a chord that begins on this turn and ends on the next; no chord is half
/// a turn wide.
bool ends_on_the_next(const CodedFrame& frame, PulseChannel channel) {
  using enum PulseChannel;
  if (channel != NorthOut && channel != SouthOut) {
    return false;
  }
  const auto in_s = behind_sun1_s(frame, channel == NorthOut ? NorthIn : SouthIn);
  const auto out_s = behind_sun1_s(frame, channel);
  return in_s && out_s && *out_s < *in_s - 0.5 * *frame.period_s;
}

}  // namespace

std::vector<Pulse> edges_of(const CodedFrame& frame) {
  std::vector<Pulse> edges{{.t = frame.t, .channel = PulseChannel::Sun1}};
  const bool has_period = frame.period_s.value_or(0.0) > 0.0;
  for (std::size_t i = 0; i < kPulseChannels; ++i) {
    const auto channel = static_cast<PulseChannel>(i);
    const auto& delay_s = frame.delay_s.at(i);
    if (!delay_s || channel == PulseChannel::Sun1) {
      continue;
    }
    double behind_s = has_period ? *behind_sun1_s(frame, channel) : *delay_s;
    if (has_period && ends_on_the_next(frame, channel)) {
      behind_s += *frame.period_s;
    }
    edges.push_back({.t = later_by_s(frame.t, behind_s), .channel = channel});
  }
  std::sort(edges.begin(), edges.end());
  return edges;
}

}  // namespace spindrift
