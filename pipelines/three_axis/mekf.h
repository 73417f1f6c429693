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
/// linear between samples, the bias a slow random walk.
///
/// Errors b of the mission file are considered, not estimated: the gains are those of the noise
/// alone, and the derivative S of the error by b is carried beside the covariance P of the noise.
/// The total covariance is P + S B S'.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "pipelines/frames/uncertain_attitude.h"
#include "pipelines/observation/observation.h"
#include "pipelines/three_axis/alignment_evidence.h"
#include "pipelines/three_axis/rate_span.h"
#include "pipelines/three_axis/sensor_errors.h"

namespace spindrift {

/// Holds an attitude measured by a star tracker, with an isotropic error.
struct ObservedAttitude {
  Eigen::Quaterniond q_icrf_body;  ///< Attitude; the sign is arbitrary.
  double sigma_rad;                ///< One standard deviation about each axis.
};

class Mekf {
 public:
  /// @param bias_sigma_rad_s Standard deviation of the bias of each axis; its prior mean is 0.
  /// @param alignment Prior covariance of the errors.
  Mekf(const SensitiveAttitude& attitude, double bias_sigma_rad_s,
       const FilterAlignment& alignment = FilterAlignment::Zero());

  void propagate(const RateSpan& span, const SpanErrors& errors);

  /// Holds the difference between a measurement and the filter's prediction, rad. It has two
  /// components for a direction (about axes across it), three for an attitude (body) and for a
  /// direction with the strength of the field. Sigma and NIS are of the total covariance.
  struct Innovation {
    Residual residual;
    double nis;
  };
  Innovation innovation(const SeenDirection& seen) const;
  Innovation innovation(const ObservedAttitude& attitude) const;
  /// Takes the attitude of another filter as the measurement, with an isotropic error.
  Innovation innovation(const Mekf& other) const;

  /// Updates the state. The measurement is linearised at the updated state, so that a large
  /// correction does not claim knowledge of a turn that the direction does not measure.
  /// @return Normalised square of what errors of the mission file, as the innovations before have
  ///         shown them, leave of the innovation; independent from one measurement to the next.
  double update(const SeenDirection& seen);
  double update(const ObservedAttitude& attitude);

  using Covariance = Eigen::Matrix<double, 6, 6>;

  const Eigen::Quaterniond& q_icrf_body() const { return q_icrf_body_; }
  const Eigen::Vector3d& bias_rad_s() const { return bias_rad_s_; }
  /// Returns the total covariance of turn (rad) and bias (rad/s), in this order.
  Covariance covariance() const;
  /// @param noise_factor Factor of the variance of the noise.
  Eigen::Matrix3d attitude_covariance_rad2(double noise_factor = 1.0) const;
  /// Returns what the covariance of the attitude would be if the mission file were exact.
  Eigen::Matrix3d attitude_noise_rad2() const { return covariance_.topLeftCorner<3, 3>(); }
  const AlignmentEvidence& evidence() const { return evidence_; }

 private:
  template <int kSize>
  struct Seen;
  template <int kSize>
  Innovation innovation_of(const Seen<kSize>& seen) const;
  template <int kSize, class Observed>
  double work_in(const Observed& observed);
  template <int kSize>
  Seen<kSize> seen_from(const Eigen::Quaterniond& q_icrf_body, const SeenDirection& seen) const;
  template <int kSize>
  Seen<kSize> seen_from(const Eigen::Quaterniond& q_icrf_body,
                        const ObservedAttitude& attitude) const;

  using Sensitivity = Eigen::Matrix<double, 6, kFilterErrors>;

  void correct_turn(const Eigen::Matrix<double, 6, 1>& weighted);

  Eigen::Quaterniond q_icrf_body_;
  Eigen::Vector3d bias_rad_s_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d rate_rad_s_ = Eigen::Vector3d::Zero();  ///< Rate without bias, 0 at first.
  Covariance covariance_ = Covariance::Zero();            ///< Covariance by noise.
  Sensitivity per_error_ = Sensitivity::Zero();           ///< Derivative of turn and bias.
  /// Covariance of the turn less the measured turn, as it is in `per_error_`, with the error.
  Eigen::Matrix<double, 3, 6> turn_noise_ = Eigen::Matrix<double, 3, 6>::Zero();
  AlignmentEvidence evidence_;
};

}  // namespace spindrift
