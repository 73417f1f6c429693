/// @file
/// Directions spread evenly over the sphere.

#pragma once

#include <Eigen/Core>
#include <cmath>

#include "pipelines/frames/angle.h"

namespace spindrift {

inline constexpr double kGolden = 0.6180339887498949;

/// Returns a unit vector of a spiral from pole to pole, whose places are turned by the golden
/// ratio.
/// @param i Number of the place, from 0 to below `places`.
inline Eigen::Vector3d place_on_spiral(int i, int places) {
  const double z = 1.0 - (2.0 * i + 1.0) / places;
  const double ra_rad = kTurn_rad * kGolden * i;
  const double across = std::sqrt(1.0 - z * z);
  return {across * std::cos(ra_rad), across * std::sin(ra_rad), z};
}

}  // namespace spindrift
