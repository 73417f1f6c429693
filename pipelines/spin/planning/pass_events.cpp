#include "pipelines/spin/planning/pass_events.h"

#include <algorithm>
#include <utility>

namespace spindrift {

void PassEvents::add(TaiTime t, const std::vector<PassCondition>& conditions) {
  last_ = t;
  for (auto event = open_.begin(); event != open_.end();) {
    if (std::find(conditions.begin(), conditions.end(), event->condition) != conditions.end()) {
      ++event;
      continue;
    }
    event->to = t;
    closed_.push_back(std::move(*event));
    event = open_.erase(event);
  }
  for (const PassCondition& condition : conditions) {
    if (std::none_of(open_.begin(), open_.end(),
                     [&](const auto& event) { return event.condition == condition; })) {
      open_.push_back({.from = t, .to = t, .condition = condition});
    }
  }
}

std::vector<PassEvent> PassEvents::finish() {
  for (PassEvent& event : open_) {
    event.to = last_;
    closed_.push_back(std::move(event));
  }
  open_.clear();
  std::stable_sort(closed_.begin(), closed_.end(),
                   [](const PassEvent& a, const PassEvent& b) { return a.from < b.from; });
  return std::move(closed_);
}

}  // namespace spindrift
