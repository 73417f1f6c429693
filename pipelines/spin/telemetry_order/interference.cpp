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
  Judged last{.pulse = pulse, .spoilt_by = {}};
  latest_.at(index_of(pulse.channel)).reset();
  for (const auto& other : latest_) {
    const auto spoilt_by = other ? spoiling(*other, pulse.t) : std::nullopt;
    if (spoilt_by && (!last.spoilt_by || spoilt_by->gap_s < last.spoilt_by->gap_s)) {
      last.spoilt_by = spoilt_by;
    }
  }
  latest_.at(index_of(pulse.channel)) = pulse.t;
  // Held edges that are not spoilt yet came last and are all of one channel.
  for (auto before = held_.rbegin();
       before != held_.rend() && !before->spoilt_by && before->pulse.channel != pulse.channel;
       ++before) {
    before->spoilt_by = spoiling(before->pulse.t, pulse.t);
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

/// Returns the gap between two edges of different channels; empty when it is wide enough.
std::optional<EdgeGap> InterferenceWindow::spoiling(TaiTime one, TaiTime later) const {
  return span_between(one, later) < window_
             ? std::optional{EdgeGap{.gap_s = elapsed_s(one, later),
                                     .least_s = std::chrono::duration<double>{window_}.count()}}
             : std::nullopt;
}

void InterferenceWindow::give_front(std::vector<Judged>& out) {
  out.push_back(held_.front());
  held_.pop_front();
}

}  // namespace spindrift
