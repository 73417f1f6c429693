/// @file
/// Laws that ask for a torque, body axes, by what is measured.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace spindrift {

struct MeasuredBody {
  Eigen::Quaterniond q_icrf_body;
  Eigen::Vector3d rate_body_rad_s;
  Eigen::Vector3d momentum_body_nms;  ///< Of body and wheels.
  Eigen::Vector3d sun_body;           ///< Unit.
};

/// -gain rate
struct RateFeedback {
  Eigen::Vector3d gain_nms;  ///< About each axis.

  Eigen::Vector3d torque_body_nm(const MeasuredBody& measured) const;
};

/// All the torque against the rate about each axis that turns faster than the dead band.
struct RelayDamping {
  double torque_nm;
  double dead_band_rad_s;

  Eigen::Vector3d torque_body_nm(const MeasuredBody& measured) const;
};

/// Turns -Z to the Sun by the short way. In the plane of angle and rate it follows a curve,
///
///     rate = min(slew, sqrt(angle torque / largest moment), angle 0.1 / s),
///
/// so that half of the torque brakes, and asks for what brings the rate to the curve in one period:
/// thrusters pulse the longer the farther off it is, and are off near it.
struct SunAcquisition {
  Eigen::Matrix3d inertia_kg_m2;
  double torque_nm_most;  ///< About each axis.
  double slew_rad_s;
  double period_s;

  Eigen::Vector3d torque_body_nm(const MeasuredBody& measured) const;
};

struct AttitudeTarget {
  Eigen::Quaterniond q_icrf_target;
  Eigen::Vector3d rate_target_rad_s = Eigen::Vector3d::Zero();  ///< Of the target, its axes.
};

struct PdGains {
  Eigen::Vector3d kp_nm;
  Eigen::Vector3d kd_nms;

  /// kp = 2 J wn^2, kd = 2 damping J wn: so that small angles close as with this frequency and
  /// damping.
  static PdGains of(const Eigen::Vector3d& moments_kg_m2, double frequency_rad_s, double damping);
};

/// Zhang 2019, eq. 12 to 15: -kp sat(qe) - kd we + w x h. The vector part of the error, taken the
/// short way, keeps its direction and has no element above the limit: what is far off turns evenly.
struct SaturatedPd {
  AttitudeTarget target;
  PdGains gains;
  double error_most;  ///< Of an element of the quaternion; (0, 1].

  Eigen::Vector3d torque_body_nm(const MeasuredBody& measured) const;
};

/// Huang 2009, after Wie: -sat(kp sat_L(qe) + kd we), by the length of the torque outside and about
/// each axis inside, where
///
///     L = kd / kp min(sqrt(4 a |qe|), fastest),    a = most torque / moment
///
/// lets an axis turn as fast as its torque can still stop it at the target.
struct VariableLimitPd {
  AttitudeTarget target;
  PdGains gains;
  Eigen::Vector3d moments_kg_m2;
  double torque_nm_most;
  Eigen::Vector3d rate_rad_s_most;

  Eigen::Vector3d torque_body_nm(const MeasuredBody& measured) const;
};

}  // namespace spindrift
