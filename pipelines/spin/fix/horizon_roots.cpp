#include "pipelines/spin/fix/horizon_roots.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "pipelines/frames/celestial.h"
#include "pipelines/spin/measurement/beam_view.h"
#include "pipelines/spin/sensor_model/geometry.h"

namespace spindrift {
namespace {

// Each step is at most a tenth of the last; a slower root is about to vanish.
constexpr int kMostSteps = 10;
constexpr double kAtRest_rad = 1e-8;
// Roots closer than this are the same.
constexpr double kSame_rad = 1e-6;

Eigen::Vector3d axis_of(const SunEarthDirections& sun_earth, const AxisAngles& place) {
  return axis_icrf(AxisInput<double>{.sun_icrf = sun_earth.sun_icrf,
                                     .earth_icrf = sun_earth.earth_icrf,
                                     .sun_angle_rad = place.sun_angle_rad.value(),
                                     .earth_angle_rad = place.earth_angle_rad.value(),
                                     .dihedral_rad = place.dihedral_rad.value()})
      .normalized();
}

/// Returns the root that `place` converges to, or no root if it vanishes.
AxisSolutions follow(const FixInput& on_sphere, const AxisAngles& place) {
  const SunEarthDirections& sun_earth = on_sphere.sun_earth;
  Eigen::Vector3d axis_icrf = axis_of(sun_earth, place);
  const auto off_rad = [&](const AxisAngles& other) {
    return angle_between_rad(axis_of(sun_earth, other), axis_icrf);
  };
  AxisSolutions found;
  for (int step = 0; step < kMostSteps; ++step) {
    found = solve_axis_angles(
        fix_input(on_sphere.config, on_sphere.measured, sun_earth,
                  views_of_horizon(on_sphere.config, on_sphere.measured, sun_earth, axis_icrf)));
    if (found.places.empty()) {
      return found;
    }
    const AxisAngles nearest = *std::min_element(
        found.places.begin(), found.places.end(),
        [&](const AxisAngles& a, const AxisAngles& b) { return off_rad(a) < off_rad(b); });
    found.places = {nearest};
    const double moved_rad = off_rad(nearest);
    if (moved_rad < kAtRest_rad) {
      return found;
    }
    axis_icrf = axis_of(sun_earth, nearest);
  }
  found.near_tangent = true;
  return found;
}

bool is_among(const std::vector<AxisAngles>& places, const AxisAngles& place,
              const SunEarthDirections& sun_earth) {
  const Eigen::Vector3d axis_icrf = axis_of(sun_earth, place);
  return std::any_of(places.begin(), places.end(), [&](const AxisAngles& other) {
    return angle_between_rad(axis_of(sun_earth, other), axis_icrf) < kSame_rad;
  });
}

}  // namespace

AxisSolutions solve_on_horizon(const FixInput& on_sphere) {
  AxisSolutions first = solve_axis_angles(on_sphere);
  if (first.places.empty()) {
    return first;
  }
  AxisSolutions found;
  for (const AxisAngles& place : first.places) {
    AxisSolutions there = follow(on_sphere, place);
    found.near_tangent = found.near_tangent || there.near_tangent;
    found.reason = std::move(there.reason);
    if (!there.places.empty() &&
        !is_among(found.places, there.places.front(), on_sphere.sun_earth)) {
      found.places.push_back(there.places.front());
    }
  }
  rank(on_sphere, found);
  return found;
}

}  // namespace spindrift
