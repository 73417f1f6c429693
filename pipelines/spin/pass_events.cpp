#include "pipelines/spin/pass_events.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "pipelines/spin/pass_conditions.h"

namespace spindrift {
namespace {

constexpr std::chrono::seconds kSharp{1};

bool contains(const std::vector<std::string>& conditions, const std::string& what) {
  return std::find(conditions.begin(), conditions.end(), what) != conditions.end();
}

/// When it begins (ceases) to hold that did not hold (held) at the first of two times.
Expected<TaiTime> change_between(PassScene& scene, TaiTime before, TaiTime after,
                                 const std::string& what, bool begins) {
  while (after - before > kSharp) {
    const TaiTime middle = before + (after - before) / 2;
    const auto geometry = scene.at(middle);
    if (!geometry) {
      return Unexpected{geometry.error()};
    }
    (contains(conditions_of(scene.config(), *geometry), what) == begins ? after : before) = middle;
  }
  return after;
}

}  // namespace

Expected<void> PassEvents::add(PassScene& scene, const PassGeometry& geometry) {
  const auto conditions = conditions_of(scene.config(), geometry);
  const TaiTime before = open_.empty() ? geometry.t : last_;
  last_ = geometry.t;
  for (auto event = open_.begin(); event != open_.end();) {
    if (contains(conditions, event->what)) {
      ++event;
      continue;
    }
    const auto end = change_between(scene, before, last_, event->what, false);
    if (!end) {
      return Unexpected{end.error()};
    }
    event->to = *end;
    closed_.push_back(std::move(*event));
    event = open_.erase(event);
  }
  for (const std::string& what : conditions) {
    if (std::none_of(open_.begin(), open_.end(), [&](const auto& e) { return e.what == what; })) {
      const auto start = change_between(scene, before, last_, what, true);
      if (!start) {
        return Unexpected{start.error()};
      }
      open_.push_back({.from = *start, .to = last_, .what = what});
    }
  }
  return {};
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
