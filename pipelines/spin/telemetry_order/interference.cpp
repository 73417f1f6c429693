#include "pipelines/spin/telemetry_order/interference.h"

#include <cmath>

#include "pipelines/time/time_span.h"

namespace spindrift {

InterferenceWindow::InterferenceWindow(double interference_s)
    : window_{static_cast<std::int64_t>(std::llround(interference_s * 1e9))} {}

std::vector<InterferenceWindow::Judged> InterferenceWindow::push(const Pulse& pulse) {
  std::vector<Judged> out;
  while (!held_.empty() && span_between(held_.front().pulse.t, pulse.t) >= window_) {
    give_front(out);
  }
  Judged last{.pulse = pulse, .spoilt = false};
  ++held_of_.at(index_of(pulse.channel));
  if (held_of_.at(index_of(pulse.channel)) <= held_.size()) {
    last.spoilt = true;
    // Held edges that are not spoilt yet came last and are all of one channel.
    for (auto before = held_.rbegin();
         before != held_.rend() && !before->spoilt && before->pulse.channel != pulse.channel;
         ++before) {
      before->spoilt = true;
    }
  }
  held_.push_back(last);
  if (window_ <= std::chrono::nanoseconds::zero()) {
    give_front(out);
  }
  return out;
}

std::vector<InterferenceWindow::Judged> InterferenceWindow::finish() {
  std::vector<Judged> out;
  while (!held_.empty()) {
    give_front(out);
  }
  return out;
}

void InterferenceWindow::give_front(std::vector<Judged>& out) {
  --held_of_.at(index_of(held_.front().pulse.channel));
  out.push_back(held_.front());
  held_.pop_front();
}

}  // namespace spindrift
