#include "pipelines/spin/telemetry_order/pulse_reorder_window.h"

#include <algorithm>

#include "pipelines/spin/types/spin_rate.h"

namespace spindrift {
namespace {

constexpr double kSlowestTurn_s = 60.0 / kSlowestSpin_rpm;

}  // namespace

std::chrono::nanoseconds reorder_horizon(const Pulse& /*pulse*/) { return std::chrono::seconds{1}; }

std::chrono::nanoseconds reorder_horizon(const CodedFrame& frame) {
  const double turn_s = std::clamp(frame.period_s.value_or(kSlowestTurn_s), 0.0, kSlowestTurn_s);
  return std::chrono::nanoseconds{static_cast<std::int64_t>(2.5 * turn_s * 1e9)};
}

template class BasicReorderWindow<Pulse>;
template class BasicReorderWindow<CodedFrame>;

}  // namespace spindrift
