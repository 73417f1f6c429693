/// @file
/// Converts radians of the pipelines to degrees and turns per minute for people.

#pragma once

#include <Eigen/Core>
#include <cmath>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

inline constexpr double kRpmPerHourPerRad_s2 = kRpmPerRad_s * kHour_s;

/// A direction with right ascension in [0, 360) and declination in [-90, 90].
struct PlaceDeg {
  double ra_deg;
  double dec_deg;
};

/// @param direction_icrf Need not have unit length.
inline PlaceDeg place_deg(const Eigen::Vector3d& direction_icrf) {
  const RaDec place = ra_dec_of(direction_icrf);
  const double ra_deg = place.ra_rad * kDegPerRad;
  // The last double below 2 pi becomes 360 exactly.
  return {.ra_deg = ra_deg == 360.0 ? 0.0 : ra_deg, .dec_deg = place.dec_rad * kDegPerRad};
}

/// Returns the 1-sigma of both axes together: the square root of the trace.
inline double sigma_deg(const Eigen::Matrix2d& covariance_rad2) {
  return std::sqrt(covariance_rad2.trace()) * kDegPerRad;
}

}  // namespace spindrift
