/// @file
/// Readings of the sensors of a three-axis spacecraft, computed from the truth and an error.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <limits>
#include <optional>

#include "pipelines/frames/rotation_vector.h"

namespace spindrift {

/// Rounds each component to the nearest multiple of `resolution`, and not at all where that is 0.
inline Eigen::Vector3d rounded(const Eigen::Vector3d& reading, double resolution) {
  return resolution > 0.0 ? Eigen::Vector3d{resolution * (reading / resolution).array().round()}
                          : reading;
}

/// @param range_rad_s Rate at which the gyro saturates about each axis; empty: it does not.
inline Eigen::Vector3d gyro_reading(const Eigen::Vector3d& rate_body_rad_s,
                                    const Eigen::Vector3d& error_rad_s,
                                    const std::optional<double>& range_rad_s) {
  const double most_rad_s = range_rad_s.value_or(std::numeric_limits<double>::max());
  return (rate_body_rad_s + error_rad_s).cwiseMax(-most_rad_s).cwiseMin(most_rad_s);
}

/// @param direction_body Unit vector.
/// @param off_rad Displacement of the direction along two axes across it.
inline Eigen::Vector3d direction_reading(const Eigen::Vector3d& direction_body,
                                         const Eigen::Vector2d& off_rad) {
  const Eigen::Vector3d first = direction_body.unitOrthogonal();
  const Eigen::Vector3d second = direction_body.cross(first);
  return quaternion_by(off_rad.x() * second - off_rad.y() * first) * direction_body;
}

/// @param off_rad Small rotation vector of the error, sensor axes. @return q_icrf_sensor.
inline Eigen::Quaterniond star_reading(const Eigen::Quaterniond& q_icrf_body,
                                       const Eigen::Quaterniond& q_body_sensor,
                                       const Eigen::Vector3d& off_rad) {
  return q_icrf_body * q_body_sensor * quaternion_by(off_rad);
}

}  // namespace spindrift
