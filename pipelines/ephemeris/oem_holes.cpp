#include "pipelines/ephemeris/oem_holes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <optional>
#include <utility>

#include "pipelines/ephemeris/state_jump.h"

namespace spindrift {
namespace {

// 1 km is 0.008 deg of the nadir direction near the Earth, half a sigma of the axis of a good pass.
constexpr double kBridged_km = 1.0;
constexpr double kLonger = 1.5;  // One missing line doubles a uniform step.

/// Returns the part with the points from `first` up to before `last`, cut to the usable times.
OemSegment part_of(const OemSegment& segment, std::size_t first, std::size_t last) {
  OemSegment part = segment;
  const auto begin = segment.points.begin();
  part.points.assign(std::next(begin, static_cast<std::ptrdiff_t>(first)),
                     std::next(begin, static_cast<std::ptrdiff_t>(last)));
  part.usable_from = std::max(segment.usable_from, part.points.front().t);
  part.usable_to = std::min(segment.usable_to, part.points.back().t);
  return part;
}

bool can_be_used(const OemSegment& part) {
  const auto needed = static_cast<std::size_t>(points_needed(part.interpolation, part.degree));
  return part.points.size() >= needed && part.usable_from <= part.usable_to;
}

/// Makes all points usable, also those outside the usable times: the interpolation uses them.
Expected<OrbitEphemeris> usable_everywhere(OemSegment segment) {
  segment.usable_from = segment.points.front().t;
  segment.usable_to = segment.points.back().t;
  return OrbitEphemeris::make({std::move(segment)});
}

/// Returns whether the interpolation between two of its points agrees with two-body motion.
bool bridges(const OrbitEphemeris& ephemeris, const EphemerisPoint& from,
             const EphemerisPoint& to) {
  const auto expected_km = halfway_icrf_km(from, to);
  if (!expected_km) {
    return true;
  }
  return ephemeris.at(from.t + (to.t - from.t) / 2)
      .map([&](const OrbitState& halfway) {
        return (halfway.position_icrf_km - *expected_km).norm() <= kBridged_km;
      })
      .value_or(false);
}

/// Returns the indices of the points that follow holes.
Expected<std::vector<std::size_t>> behind_holes(const OemSegment& segment) {
  return usable_everywhere(segment).map([&](const OrbitEphemeris& everywhere) {
    const auto& points = segment.points;
    const auto step_s = [&](std::size_t i) {
      return seconds_between(points[i - 1].t, points[i].t);
    };
    double shortest_s = step_s(1);
    for (std::size_t i = 2; i < points.size(); ++i) {
      shortest_s = std::min(shortest_s, step_s(i));
    }
    std::vector<std::size_t> behind;
    for (std::size_t i = 1; i < points.size(); ++i) {
      if (step_s(i) > kLonger * shortest_s && !bridges(everywhere, points[i - 1], points[i])) {
        behind.push_back(i);
      }
    }
    return behind;
  });
}

int first_usable_line(const OemSegment& segment) {
  return std::lower_bound(segment.points.begin(), segment.points.end(), segment.usable_from,
                          [](const EphemerisPoint& point, TaiTime t) { return point.t < t; })
      ->line;
}

}  // namespace

Expected<OrbitEphemeris> cut_at_holes(const OrbitEphemeris& ephemeris) {
  std::vector<OemSegment> parts;
  std::optional<EphemerisPoint> behind_hole;
  for (const OemSegment& segment : ephemeris.segments()) {
    std::size_t first = 0;
    const auto add_up_to = [&](std::size_t last) {
      if (OemSegment part = part_of(segment, first, last); can_be_used(part)) {
        parts.push_back(std::move(part));
      }
      first = last;
    };
    const auto holes = behind_holes(segment);
    if (!holes) {
      return Unexpected{holes.error()};
    }
    for (const std::size_t behind : *holes) {
      behind_hole = segment.points[behind];
      add_up_to(behind);
    }
    add_up_to(segment.points.size());
  }
  if (parts.empty() && behind_hole) {
    return Unexpected{{ErrorCode::InvalidConfiguration,
                       fmt::format("orbit ephemeris, line {}: too long after the data line before "
                                   "it to be interpolated, and too few lines on either side: "
                                   "there must be more states",
                                   behind_hole->line)}};
  }
  return OrbitEphemeris::make(std::move(parts));
}

std::vector<OrbitGap> orbit_gaps(const OrbitEphemeris& ephemeris) {
  std::vector<OrbitGap> gaps;
  const auto& segments = ephemeris.segments();
  for (std::size_t i = 1; i < segments.size(); ++i) {
    if (segments[i - 1].usable_to < segments[i].usable_from) {
      gaps.push_back({.from = segments[i - 1].usable_to,
                      .to = segments[i].usable_from,
                      .line = first_usable_line(segments[i])});
    }
  }
  return gaps;
}

}  // namespace spindrift
