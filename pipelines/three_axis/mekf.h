/// @file
/// Multiplicative extended Kalman filter of attitude and gyro bias (Lefferts, Markley and Shuster
/// 1982).
///
/// The state is the quaternion q_icrf_body and the bias of the gyro; its error has six components,
///
///     q_true = q * quaternion_by(turn),    bias_true = bias + more,
///
/// the turn in body axes; after each update it is moved into the quaternion. A gyro sample is the
/// rate, the bias and an error that is independent from sample to sample; between samples the rate
/// changes evenly. The bias wanders slowly. Misalignments of sensors are no states.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "pipelines/frames/uncertain_attitude.h"
#include "pipelines/observation/observation.h"
#include "pipelines/three_axis/attitude_from_vectors.h"

namespace spindrift {

/// From one instant to another: rates as the gyro measures them at both ends.
struct RateSpan {
  double dt_s;
  Eigen::Vector3d from_rad_s;
  Eigen::Vector3d to_rad_s;
};

/// The turn of a body whose rate changes evenly, to the third order of its angle.
Eigen::Vector3d turned_rad(const RateSpan& span, const Eigen::Vector3d& bias_rad_s);

/// Errors of a span, each of one axis.
struct SpanErrors {
  double turn_rad2;     ///< Variance of the turn.
  double bias_rad2_s2;  ///< By which that of the bias grows.
};

/// A direct measurement of the attitude, by a star tracker: the same error about every axis.
struct ObservedAttitude {
  Eigen::Quaterniond q_icrf_body;  ///< Of either sign.
  double sigma_rad;                ///< One standard deviation about each axis.
};

class Mekf {
 public:
  /// @param bias_sigma_rad_s One standard deviation of the bias of each axis about 0.
  Mekf(const UncertainAttitude& attitude, double bias_sigma_rad_s);

  void propagate(const RateSpan& span, const SpanErrors& errors);

  /// How far a measurement is from where the filter has it, of two degrees of freedom (about two
  /// axes across the direction) or three (about the body's axes); rad.
  struct Innovation {
    Residual residual;
    double nis;
  };
  Innovation innovation(const ObservedDirection& direction) const;
  Innovation innovation(const ObservedAttitude& attitude) const;

  /// Linearised where it ends, so that a large correction counts no knowledge of what the
  /// direction does not measure.
  void update(const ObservedDirection& direction);
  void update(const ObservedAttitude& attitude);

  using Covariance = Eigen::Matrix<double, 6, 6>;

  const Eigen::Quaterniond& q_icrf_body() const { return q_icrf_body_; }
  const Eigen::Vector3d& bias_rad_s() const { return bias_rad_s_; }
  /// Of turn and bias.
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
