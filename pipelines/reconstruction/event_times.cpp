#include "pipelines/reconstruction/event_times.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "pipelines/time/time_span.h"
#include "pipelines/time/utc.h"

namespace spindrift {
namespace {

using enum SeparationEvent;

// Longest plausible torque-free arc.
constexpr double kLongestArc_s = 24.0 * kHour_s;

template <class Sample>
std::optional<TaiTime> first_behind(std::span<const Sample> samples, TaiTime t) {
  const auto found =
      std::lower_bound(samples.begin(), samples.end(), t,
                       [](const Sample& sample, TaiTime time) { return sample.t < time; });
  return found == samples.end() ? std::nullopt : std::optional{found->t};
}

std::optional<Error> out_of_order(const std::vector<EventTime>& events) {
  for (std::size_t i = 1; i < events.size(); ++i) {
    const EventTime& before = events[i - 1];
    const EventTime& behind = events[i];
    if (behind.t < before.t) {
      return Error{ErrorCode::InvalidInput,
                   fmt::format("{} is {}, before {} at {}: T1 <= T2 <= T3 <= T4 is allowed",
                               name_of(behind.event), format_utc(behind.t), name_of(before.event),
                               format_utc(before.t))};
    }
  }
  const double arc_s = elapsed_s(events[0].t, events[1].t);
  if (arc_s > kLongestArc_s) {
    return Error{ErrorCode::InvalidInput,
                 fmt::format("T1 is {}, {:.0f} s before T2: at most {:.0f} s are allowed",
                             format_utc(events[0].t), arc_s, kLongestArc_s)};
  }
  return std::nullopt;
}

}  // namespace

Error nothing_anchored(TaiTime t) {
  return {ErrorCode::Unobservable,
          fmt::format("no star fix lies behind {}: nothing can be anchored; samples up to one that "
                      "does are needed",
                      format_utc(t))};
}

Expected<std::vector<EventTime>> event_times(const SeparationTimes& times,
                                             const SamplesInOrder& samples) {
  if (samples.gyro.empty()) {
    return Unexpected{{ErrorCode::Unobservable, "no gyro sample: at least 2 are needed"}};
  }
  const auto star_behind = [&](TaiTime t) {
    return times.first_star_fix ? times.first_star_fix : first_behind(samples.stars, t);
  };
  const TaiTime control_on = times.control_on.value_or(
      first_behind(samples.gyro, times.separation).value_or(samples.gyro.front().t));
  auto acquisition = times.acquisition ? times.acquisition : first_behind(samples.sun, control_on);
  auto star = star_behind(acquisition.value_or(control_on));
  // A sun vector later than all star fixes does not mark the acquisition before them.
  if (!times.acquisition && acquisition && (!star || *star < *acquisition)) {
    acquisition.reset();
    star = star_behind(control_on);
  }
  if (!star) {
    return Unexpected{nothing_anchored(acquisition.value_or(control_on))};
  }
  std::vector<EventTime> events{{Separation, times.separation, false},
                                {ControlOn, control_on, !times.control_on}};
  if (acquisition) {
    events.push_back({Acquisition, *acquisition, !times.acquisition});
  }
  events.push_back({FirstStarFix, *star, !times.first_star_fix});
  if (auto error = out_of_order(events)) {
    return Unexpected{*std::move(error)};
  }
  return events;
}

}  // namespace spindrift
