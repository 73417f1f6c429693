/// @file
/// What the sensors of a three-axis spacecraft measure, as received: normalised where it is used.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "pipelines/core/rounding.h"
#include "pipelines/core/sender.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

/// The length of a unit vector or quaternion as it is sent may be off by this, by rounding.
inline constexpr double kUnitTolerance = 1e-3;

/// Of the gyro triad, at `t`.
struct GyroSample {
  TaiTime t;
  Eigen::Vector3d rate_body_rad_s = Eigen::Vector3d::Zero();
  Sender sender = Sender::First;
};

/// Of the star tracker. v_icrf = q v_sensor q*; its length is 1 within kUnitTolerance.
struct StarFix {
  TaiTime t;
  Eigen::Quaterniond q_icrf_sensor = Eigen::Quaterniond::Identity();
  Sender sender = Sender::First;
};

/// Of the sun sensor: to the Sun, its length is 1 within kUnitTolerance.
struct SunDirection {
  TaiTime t;
  Eigen::Vector3d sun_body = Eigen::Vector3d::UnitX();
  Sender sender = Sender::First;
};

/// @name Whether two samples say the same, but for rounding
/// @{
inline bool are_same(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return same_but_for_rounding<3>({a.x(), a.y(), a.z()}, {b.x(), b.y(), b.z()});
}
inline bool say_the_same(const GyroSample& a, const GyroSample& b) {
  return are_same(a.rate_body_rad_s, b.rate_body_rad_s);
}
inline bool are_same(const Eigen::Vector4d& a, const Eigen::Vector4d& b) {
  return same_but_for_rounding<4>({a.x(), a.y(), a.z(), a.w()}, {b.x(), b.y(), b.z(), b.w()});
}
/// As they are sent, or as they are used: of length 1.
inline bool say_the_same(const SunDirection& a, const SunDirection& b) {
  return are_same(a.sun_body, b.sun_body) ||
         are_same(a.sun_body.normalized(), b.sun_body.normalized());
}
/// Likewise; q and -q are one attitude.
inline bool say_the_same(const StarFix& a, const StarFix& b) {
  const Eigen::Vector4d one = a.q_icrf_sensor.coeffs();
  Eigen::Vector4d other = b.q_icrf_sensor.coeffs();
  other *= one.dot(other) < 0.0 ? -1.0 : 1.0;
  return are_same(one, other) ||
         are_same(Eigen::Vector4d{one.normalized()}, Eigen::Vector4d{other.normalized()});
}
/// @}

}  // namespace spindrift
