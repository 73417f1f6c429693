/// @file
/// Multiplicative extended Kalman filter of attitude and gyro bias (Lefferts, Markley and Shuster
/// 1982).
///
/// The state is the quaternion q_icrf_body and the gyro bias; its error has six components,
///
///     q_true = q * quaternion_by(turn),    bias_true = bias + more,
///
/// with the turn in body axes, which each update moves into the quaternion. A gyro sample is the
/// sum of the rate, the bias and an error that is independent from sample to sample. The rate is
/// linear between samples, the bias a slow random walk. Misalignments are not estimated.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "pipelines/frames/uncertain_attitude.h"
#include "pipelines/observation/observation.h"
#include "pipelines/three_axis/attitude_from_vectors.h"

namespace spindrift {

/// Holds the measured rates at both ends of a time step.
struct RateSpan {
  double dt_s;
  Eigen::Vector3d from_rad_s;
  Eigen::Vector3d to_rad_s;
};

/// Returns the rotation vector of a body whose rate changes linearly, to third order of its angle.
Eigen::Vector3d turned_rad(const RateSpan& span, const Eigen::Vector3d& bias_rad_s);

/// Holds the process noise of a time step, per axis.
struct SpanErrors {
  double turn_rad2;     ///< Variance of the turn.
  double bias_rad2_s2;  ///< Growth of the variance of the bias.
};

/// Holds an attitude measured by a star tracker, with an isotropic error.
struct ObservedAttitude {
  Eigen::Quaterniond q_icrf_body;  ///< Attitude; the sign is arbitrary.
  double sigma_rad;                ///< One standard deviation about each axis.
};

class Mekf {
 public:
  /// @param bias_sigma_rad_s Standard deviation of the bias of each axis; its prior mean is 0.
  Mekf(const UncertainAttitude& attitude, double bias_sigma_rad_s);

  void propagate(const RateSpan& span, const SpanErrors& errors);

  /// Holds the difference between a measurement and the filter's prediction, rad. It has two
  /// components for a direction (about axes across it), three for an attitude (body).
  struct Innovation {
    Residual residual;
    double nis;
  };
  Innovation innovation(const ObservedDirection& direction) const;
  Innovation innovation(const ObservedAttitude& attitude) const;

  /// Updates the state. The measurement is linearised at the updated state, so that a large
  /// correction does not claim knowledge of a turn that the direction does not measure.
  void update(const ObservedDirection& direction);
  void update(const ObservedAttitude& attitude);

  using Covariance = Eigen::Matrix<double, 6, 6>;

  const Eigen::Quaterniond& q_icrf_body() const { return q_icrf_body_; }
  const Eigen::Vector3d& bias_rad_s() const { return bias_rad_s_; }
  /// Covariance of turn (rad) and bias (rad/s), in this order.
  const Covariance& covariance() const { return covariance_; }
  Eigen::Matrix3d attitude_covariance_rad2() const { return covariance_.topLeftCorner<3, 3>(); }

 private:
  template <int kSize, class Observed>
  Innovation innovation_of(const Observed& observed) const;
  template <int kSize, class Observed>
  void work_in(const Observed& observed);

  Eigen::Quaterniond q_icrf_body_;
  Eigen::Vector3d bias_rad_s_ = Eigen::Vector3d::Zero();
  Covariance covariance_ = Covariance::Zero();
};

}  // namespace spindrift
