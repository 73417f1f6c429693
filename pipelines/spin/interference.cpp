#include "pipelines/spin/interference.h"

#include <cmath>

#include "pipelines/spin/time_span.h"

namespace spindrift {

InterferenceWindow::InterferenceWindow(double interference_s)
    : window_{static_cast<std::int64_t>(std::llround(interference_s * 1e9))} {}

InterferenceWindow::Sorted InterferenceWindow::push(const Pulse& pulse) {
  Sorted out;
  while (!held_.empty() && span_between(held_.front().pulse.t, pulse.t) >= window_) {
    give_front(out);
  }
  Held last{.pulse = pulse, .spoilt = false};
  for (Held& before : held_) {
    if (before.pulse.channel != pulse.channel) {
      before.spoilt = last.spoilt = true;
    }
  }
  held_.push_back(last);
  if (window_ <= std::chrono::nanoseconds::zero()) {
    give_front(out);
  }
  return out;
}

InterferenceWindow::Sorted InterferenceWindow::finish() {
  Sorted out;
  while (!held_.empty()) {
    give_front(out);
  }
  return out;
}

void InterferenceWindow::give_front(Sorted& out) {
  (held_.front().spoilt ? out.spoilt : out.clean).push_back(held_.front().pulse);
  held_.pop_front();
}

}  // namespace spindrift
