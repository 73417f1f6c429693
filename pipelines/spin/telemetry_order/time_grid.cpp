#include "pipelines/spin/telemetry_order/time_grid.h"

#include <algorithm>
#include <cstdlib>
#include <numeric>
#include <optional>
#include <utility>

#include "pipelines/time/time_span.h"

namespace spindrift {

TimeGrid::TimeGrid(const PulseNoise& noise)
    : least_ns_{std::max(1e-3 * 1e9 * std::min(noise.sun_s, noise.infrared_s), 1.0)} {}

void TimeGrid::learn(const Pulse& edge) {
  const std::optional<TaiTime>& sun1 = last_[index_of(PulseChannel::Sun1)];
  std::optional<TaiTime>& last = last_[index_of(edge.channel)];
  if (edge.channel != PulseChannel::Sun1 && sun1) {
    add(span_between(*sun1, edge.t).count(), behind_sun1_);
  }
  if (last) {
    add(span_between(*last, edge.t).count(), behind_each_other_[index_of(edge.channel)]);
  }
  last = edge.t;
}

void TimeGrid::add(std::int64_t difference_ns, Run& run) {
  run.divisor_ns = std::gcd(run.divisor_ns, difference_ns);
  run.smallest_ns = std::min(run.smallest_ns, std::abs(difference_ns));
  if (++run.differences == 20) {
    end(std::exchange(run, {}));
  }
}

/// Ends a run. Differences that are multiples of the smallest of them show no grid: turns of one
/// length give such differences.
void TimeGrid::end(const Run& run) {
  const bool is_of_turns = run.divisor_ns == run.smallest_ns;
  if (is_of_turns || static_cast<double>(run.divisor_ns) <= least_ns_) {
    return;
  }
  // A single run may have a multiple of the grid by chance; one in 2^20 has its double, harmlessly.
  if (++runs_[run.divisor_ns] >= 2) {
    width_s_ = std::max(width_s_, 1e-9 * static_cast<double>(run.divisor_ns));
  }
}

}  // namespace spindrift
