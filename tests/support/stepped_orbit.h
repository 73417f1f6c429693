/// @file
/// An orbit of two segments with a discontinuity between them.

#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <iterator>
#include <utility>

#include "pipelines/ephemeris/oem.h"

namespace spindrift::testing {

/// Returns the segment interpolated between two points only, so that it may be cut near its ends.
inline OemSegment of_few_points(OemSegment segment) {
  segment.interpolation = Interpolation::Hermite;
  segment.degree = 3;
  return segment;
}

/// Cuts the segment in two at its first state from `t` on, which both parts contain; the second
/// part starts with a position offset of `by_km` and drifts by `by_km_s`.
inline OrbitEphemeris stepped(const OemSegment& segment, TaiTime t, const Eigen::Vector3d& by_km,
                              const Eigen::Vector3d& by_km_s) {
  const auto joint = std::find_if(segment.points.begin(), segment.points.end(),
                                  [t](const EphemerisPoint& point) { return point.t >= t; });
  OemSegment before = segment;
  before.points.assign(segment.points.begin(), std::next(joint));
  before.usable_to = joint->t;
  OemSegment behind = segment;
  behind.points.assign(joint, segment.points.end());
  behind.usable_from = joint->t;
  for (EphemerisPoint& point : behind.points) {
    point.state.position_icrf_km += by_km + seconds_between(joint->t, point.t) * by_km_s;
    point.state.velocity_icrf_km_s += by_km_s;
  }
  return OrbitEphemeris::make({std::move(before), std::move(behind)}).value();
}

}  // namespace spindrift::testing
