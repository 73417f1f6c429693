/// @file
/// What the sensors of a three-axis spacecraft measure, as received: normalised where it is used.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "pipelines/time/tai_time.h"

namespace spindrift {

/// The length of a unit vector or quaternion as it is sent may be off by this, by rounding.
inline constexpr double kUnitTolerance = 1e-3;

/// Of the gyro triad, at `t`.
struct GyroSample {
  TaiTime t;
  Eigen::Vector3d rate_body_rad_s = Eigen::Vector3d::Zero();
};

/// Of the star tracker. v_icrf = q v_sensor q*; its length is 1 within kUnitTolerance.
struct StarFix {
  TaiTime t;
  Eigen::Quaterniond q_icrf_sensor = Eigen::Quaterniond::Identity();
};

/// Of the sun sensor: to the Sun, its length is 1 within kUnitTolerance.
struct SunDirection {
  TaiTime t;
  Eigen::Vector3d sun_body = Eigen::Vector3d::UnitX();
};

}  // namespace spindrift
