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

Expected<std::vector<PassEvent>> pass_events(PassScene& scene, const std::vector<PassStep>& steps) {
  std::vector<PassEvent> events;
  std::vector<PassEvent> open;
  TaiTime before = steps.front().geometry.t;
  for (const PassStep& step : steps) {
    const TaiTime t = step.geometry.t;
    const auto conditions = conditions_of(scene.config(), step.geometry);
    for (auto event = open.begin(); event != open.end();) {
      event->to = t;
      if (contains(conditions, event->what)) {
        ++event;
        continue;
      }
      const auto end = change_between(scene, before, t, event->what, false);
      if (!end) {
        return Unexpected{end.error()};
      }
      event->to = *end;
      events.push_back(std::move(*event));
      event = open.erase(event);
    }
    for (const std::string& what : conditions) {
      if (std::none_of(open.begin(), open.end(), [&](const auto& e) { return e.what == what; })) {
        const auto start = change_between(scene, before, t, what, true);
        if (!start) {
          return Unexpected{start.error()};
        }
        open.push_back({.from = *start, .to = t, .what = what});
      }
    }
    before = t;
  }
  events.insert(events.end(), open.begin(), open.end());
  std::stable_sort(events.begin(), events.end(),
                   [](const PassEvent& a, const PassEvent& b) { return a.from < b.from; });
  return events;
}

}  // namespace spindrift
