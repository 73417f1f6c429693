#include "pipelines/spin/telemetry_order/time_grid.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "pipelines/time/time_span.h"

namespace spindrift {
namespace {

constexpr int kRun = 16;
// By chance a run has a multiple of the grid, one in 2^16 its double: a day does not have three.
constexpr int kFewestRuns = 3;
constexpr double kOfInterest = 1e-3;

}  // namespace

TimeGrid::TimeGrid(const PulseNoise& noise)
    : least_ns_{std::max(kOfInterest * 1e9 * std::min(noise.sun_s, noise.infrared_s), 1.0)} {}

void TimeGrid::note(const Pulse& edge) {
  if (edge.channel == PulseChannel::Sun1 || !reference_) {
    reference_ = edge.t;
    return;
  }
  divisor_ns_ = std::gcd(divisor_ns_, span_between(*reference_, edge.t).count());
  if (++differences_ < kRun) {
    return;
  }
  differences_ = 0;
  const std::int64_t width_ns = std::exchange(divisor_ns_, 0);
  if (static_cast<double>(width_ns) > least_ns_ && ++runs_[width_ns] >= kFewestRuns) {
    width_s_ = std::max(width_s_, 1e-9 * static_cast<double>(width_ns));
  }
}

}  // namespace spindrift
