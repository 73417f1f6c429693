#include "pipelines/spin/reorder_window.h"

#include <algorithm>
#include <utility>

namespace spindrift {

ReorderWindow::Verdict ReorderWindow::add(const Pulse& pulse) {
  if (!released_.empty() && pulse <= released_.back()) {
    const bool known = std::binary_search(released_.begin(), released_.end(), pulse);
    return known ? Verdict::Duplicate : Verdict::Late;
  }
  return held_.insert(pulse).second ? Verdict::Held : Verdict::Duplicate;
}

std::vector<Pulse> ReorderWindow::release() {
  std::vector<Pulse> due;
  while (!held_.empty() && held_.rbegin()->t - held_.begin()->t >= kReorder) {
    due.push_back(*held_.begin());
    remember(*held_.begin());
    held_.erase(held_.begin());
  }
  return due;
}

std::vector<Pulse> ReorderWindow::release_all() {
  const std::set<Pulse> held = std::exchange(held_, {});
  for (const Pulse& pulse : held) {
    remember(pulse);
  }
  return {held.begin(), held.end()};
}

void ReorderWindow::remember(const Pulse& pulse) {
  released_.push_back(pulse);
  while (pulse.t - released_.front().t > kRemembered) {
    released_.pop_front();
  }
}

}  // namespace spindrift
