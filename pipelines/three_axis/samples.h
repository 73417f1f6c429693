/// @file
/// The sensor measurements of a three-axis spacecraft as received; their users normalise them.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "pipelines/core/rounding.h"
#include "pipelines/core/sender.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

/// Largest deviation from unit length that the rounding of sent vectors and quaternions explains.
inline constexpr double kUnitTolerance = 1e-3;

/// Holds the rate measured by the gyro triad at `t`.
struct GyroSample {
  TaiTime t;
  Eigen::Vector3d rate_body_rad_s = Eigen::Vector3d::Zero();
  Sender sender = Sender::First;
};

/// Holds a star tracker fix, v_icrf = q v_sensor q*; the norm is 1 within kUnitTolerance.
struct StarFix {
  TaiTime t;
  Eigen::Quaterniond q_icrf_sensor = Eigen::Quaterniond::Identity();
  Sender sender = Sender::First;
};

/// Holds the sun sensor's unit vector to the Sun; the norm is 1 within kUnitTolerance.
struct SunDirection {
  TaiTime t;
  Eigen::Vector3d sun_body = Eigen::Vector3d::UnitX();
  Sender sender = Sender::First;
};

/// Holds the measurement of the magnetometer.
struct MagneticField {
  TaiTime t;
  Eigen::Vector3d field_body_nt = Eigen::Vector3d::Zero();
  Sender sender = Sender::First;
};

/// Returns whether two vectors agree but for rounding. The same direction may be sent with another
/// length, so the normalised vectors are compared as well.
template <int N>
bool are_same_direction(const Eigen::Vector<double, N>& a, const Eigen::Vector<double, N>& b) {
  return same_but_for_rounding(a, b) || same_but_for_rounding<N>(a.normalized(), b.normalized());
}

/// @name Whether two samples agree but for rounding
/// @{
inline bool say_the_same(const GyroSample& a, const GyroSample& b) {
  return same_but_for_rounding(a.rate_body_rad_s, b.rate_body_rad_s);
}
inline bool say_the_same(const SunDirection& a, const SunDirection& b) {
  return are_same_direction(a.sun_body, b.sun_body);
}
inline bool say_the_same(const MagneticField& a, const MagneticField& b) {
  return same_but_for_rounding(a.field_body_nt, b.field_body_nt);
}
/// The quaternions q and -q are the same attitude.
inline bool say_the_same(const StarFix& a, const StarFix& b) {
  const Eigen::Vector4d one = a.q_icrf_sensor.coeffs();
  const Eigen::Vector4d other = b.q_icrf_sensor.coeffs();
  return are_same_direction<4>(one, one.dot(other) < 0.0 ? -other : other);
}
/// @}

}  // namespace spindrift
