/// @file
/// Control laws that compute a torque in body axes from the measured state.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace spindrift {

struct MeasuredBody {
  Eigen::Quaterniond q_icrf_body;
  Eigen::Vector3d rate_body_rad_s;
  Eigen::Vector3d momentum_body_nms;  ///< Angular momentum of body and wheels.
  Eigen::Vector3d sun_body;           ///< Unit vector to the Sun.
};

/// Damps rates by the torque -gain rate.
struct RateFeedback {
  Eigen::Vector3d gain_nms;  ///< Gain about each axis.

  Eigen::Vector3d torque_body_nm(const MeasuredBody& measured) const;
};

/// Applies the full torque against the rate about each axis that turns faster than the dead band.
struct RelayDamping {
  double torque_nm;
  double dead_band_rad_s;

  Eigen::Vector3d torque_body_nm(const MeasuredBody& measured) const;
};

/// Turns -Z to the Sun by the smallest turn. In the plane of angle and rate it follows a curve,
///
///     rate = min(slew, sqrt(angle torque / largest moment), angle 0.1 / s),
///
/// so that braking takes half of the torque, and commands what brings the rate to the curve in one
/// period: thruster pulses are longer the farther the rate is off the curve, and stop near it.
struct SunAcquisition {
  Eigen::Matrix3d inertia_kg_m2;
  double torque_nm_most;  ///< Largest torque about each axis.
  double slew_rad_s;
  double period_s;

  Eigen::Vector3d torque_body_nm(const MeasuredBody& measured) const;
};

struct AttitudeTarget {
  Eigen::Quaterniond q_icrf_target;
  /// Rate of the target in its own axes.
  Eigen::Vector3d rate_target_rad_s = Eigen::Vector3d::Zero();
};

struct PdGains {
  Eigen::Vector3d kp_nm;
  Eigen::Vector3d kd_nms;

  /// Returns kp = 2 J wn^2 and kd = 2 damping J wn, for small angles of this frequency and damping.
  static PdGains of(const Eigen::Vector3d& moments_kg_m2, double frequency_rad_s, double damping);
};

/// Commands the torque of Zhang 2019, eq. 12 to 15: -kp sat(qe) - kd we + w x h. The vector part of
/// the error quaternion, of the smaller turn, is scaled so that no element exceeds the limit and
/// its direction stays: large errors are turned off at a constant rate.
struct SaturatedPd {
  AttitudeTarget target;
  PdGains gains;
  double error_most;  ///< Limit of an element of the quaternion error; (0, 1].

  Eigen::Vector3d torque_body_nm(const MeasuredBody& measured) const;
};

/// Commands the torque of Huang 2009, after Wie: -sat(kp sat_L(qe) + kd we). The outer sat limits
/// the length of the torque, the inner one each axis, where
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
