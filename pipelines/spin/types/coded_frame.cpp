#include "pipelines/spin/types/coded_frame.h"

#include <algorithm>
#include <cmath>

#include "pipelines/core/rounding.h"
#include "pipelines/time/time_span.h"

namespace spindrift {

bool say_the_same(const CodedFrame& a, const CodedFrame& b) {
  using One = Eigen::Vector<double, 1>;
  const auto is_one = [](const std::optional<double>& one, const std::optional<double>& other) {
    return one.has_value() == other.has_value() &&
           (!one || same_but_for_rounding(One{*one}, One{*other}));
  };
  return is_one(a.period_s, b.period_s) &&
         std::equal(a.delay_s.begin(), a.delay_s.end(), b.delay_s.begin(), is_one);
}

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
