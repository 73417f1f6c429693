#include "pipelines/spin/reorder_window.h"

#include <algorithm>
#include <utility>

namespace spindrift {

ReorderWindow::Verdict ReorderWindow::add(const Pulse& pulse) {
  if (!released_.empty() && pulse <= released_.back()) {
    const bool known = std::binary_search(released_.begin(), released_.end(), pulse);
    return known ? Verdict::Duplicate : Verdict::Late;
  }
  if (!is_far_ahead(pulse)) {
    far_in_a_row_ = 0;
    return held_.insert(pulse).second ? Verdict::Held : Verdict::Duplicate;
  }
  if (far_ahead_.size() >= kMostFarAhead) {
    return Verdict::OutOfTime;
  }
  if (!far_ahead_.insert(pulse).second) {
    return Verdict::Duplicate;
  }
  if (++far_in_a_row_ >= kBelieved) {
    believe();
  }
  return Verdict::Held;
}

bool ReorderWindow::is_far_ahead(const Pulse& pulse) const {
  if (!released_.empty()) {
    const TaiTime newest = held_.empty() ? released_.back().t : held_.rbegin()->t;
    return pulse.t - newest > kFarAhead;
  }
  return !held_.empty() && pulse.t - held_.rbegin()->t > kFarAhead;
}

/// Time has jumped: what was held before is due.
void ReorderWindow::believe() {
  for (const Pulse& pulse : std::exchange(held_, std::exchange(far_ahead_, {}))) {
    due_.push_back(pulse);
    remember(pulse);
  }
  far_in_a_row_ = 0;
}

std::vector<Pulse> ReorderWindow::release() {
  std::vector<Pulse> due = std::exchange(due_, {});
  while (!held_.empty()) {
    const Pulse first = *held_.begin();
    const auto younger = held_.lower_bound({.t = first.t + kReorder, .channel = {}});
    // A pulse of a bad clock that was there first does not count either.
    if (younger == held_.end() || younger->t - first.t > kFarAhead) {
      break;
    }
    due.push_back(first);
    remember(first);
    held_.erase(held_.begin());
  }
  return due;
}

ReorderWindow::Rest ReorderWindow::release_all() {
  Rest rest{.in_time = std::exchange(due_, {}), .out_of_time = {}};
  held_.merge(far_ahead_);
  std::vector<Pulse> pulses{held_.begin(), held_.end()};
  held_.clear();
  far_ahead_.clear();
  auto end = pulses.end();
  for (auto pulse = pulses.begin(); pulse != pulses.end(); ++pulse) {
    const bool is_first = pulse == pulses.begin();
    if (is_first && released_.empty()) {
      continue;
    }
    const TaiTime before = is_first ? released_.back().t : std::prev(pulse)->t;
    if (pulse->t - before > kFarAhead &&
        pulses.end() - pulse < static_cast<std::ptrdiff_t>(kBelieved)) {
      end = pulse;
      break;
    }
  }
  rest.in_time.insert(rest.in_time.end(), pulses.begin(), end);
  rest.out_of_time.assign(end, pulses.end());
  for (auto pulse = pulses.begin(); pulse != end; ++pulse) {
    remember(*pulse);
  }
  return rest;
}

void ReorderWindow::remember(const Pulse& pulse) {
  released_.push_back(pulse);
  while (pulse.t - released_.front().t > kRemembered) {
    released_.pop_front();
  }
}

}  // namespace spindrift
