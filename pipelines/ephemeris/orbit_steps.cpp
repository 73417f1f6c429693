#include "pipelines/ephemeris/orbit_steps.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "pipelines/ephemeris/state_jump.h"

namespace spindrift {
namespace {

/// Returns the state of a segment at any time within its points, even outside its usable times.
Expected<OrbitState> state_at(OemSegment segment, TaiTime t) {
  segment.usable_from = segment.points.front().t;
  segment.usable_to = segment.points.back().t;
  return OrbitEphemeris::make({std::move(segment)}).and_then([t](const OrbitEphemeris& alone) {
    return alone.at(t);
  });
}

/// Returns the step between two segments; empty where they meet or cannot be compared.
std::optional<OrbitStep> step_between(const OemSegment& before, const OemSegment& behind) {
  const TaiTime to = behind.usable_from;
  const TaiTime from = std::min(before.points.back().t, to);
  const auto left = state_at(before, from);
  const auto right = state_at(behind, to);
  if (!left || !right) {
    return std::nullopt;
  }
  const auto off = departure({.t = from, .state = *left}, {.t = to, .state = *right});
  if (!off) {
    return std::nullopt;
  }
  const auto first = std::lower_bound(behind.points.begin(), behind.points.end(), to,
                                      [](const EphemerisPoint& p, TaiTime t) { return p.t < t; });
  return OrbitStep{.from = std::min(before.usable_to, to),
                   .to = to,
                   .line = first->line,
                   .off_km = off->km,
                   .off_km_s = off->km_s};
}

}  // namespace

std::vector<OrbitStep> orbit_steps(const OrbitEphemeris& ephemeris) {
  std::vector<OrbitStep> steps;
  const auto& segments = ephemeris.segments();
  for (std::size_t i = 1; i < segments.size(); ++i) {
    if (const auto step = step_between(segments[i - 1], segments[i])) {
      steps.push_back(*step);
    }
  }
  const auto is_known = [&steps](const OrbitJump& jump) {
    return std::any_of(steps.begin(), steps.end(),
                       [&](const OrbitStep& step) { return step.line == jump.to.line; });
  };
  for (const OrbitJump& jump : orbit_jumps(ephemeris)) {
    if (!is_known(jump)) {
      steps.push_back({.from = jump.from,
                       .to = jump.to.t,
                       .line = jump.to.line,
                       .off_km = jump.off_km,
                       .off_km_s = jump.off_km_s});
    }
  }
  std::stable_sort(steps.begin(), steps.end(),
                   [](const OrbitStep& a, const OrbitStep& b) { return a.to < b.to; });
  return steps;
}

std::vector<OrbitStep> orbit_steps(const Orbit& orbit) {
  return orbit.ephemeris() == nullptr ? std::vector<OrbitStep>{} : orbit_steps(*orbit.ephemeris());
}

std::optional<OrbitStep> step_within(std::span<const OrbitStep> steps, TaiTime first,
                                     TaiTime last) {
  const auto found = std::find_if(steps.begin(), steps.end(), [&](const OrbitStep& step) {
    return first < step.to && step.from < last;
  });
  return found == steps.end() ? std::nullopt : std::optional{*found};
}

Reason reason_of(const OrbitStep& step) {
  return {ReasonCode::OrbitSteps,
          {{"t_tai_ns", tai_ns(step.to)}, {"km", step.off_km}, {"m_s", 1e3 * step.off_km_s}}};
}

}  // namespace spindrift
