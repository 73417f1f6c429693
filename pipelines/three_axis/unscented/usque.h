/// @file
/// Unscented filter of attitude and gyro bias (USQUE, Crassidis and Markley 2003). It finds the
/// attitude from far off, where the extended filter (mekf.h) may not; near it they agree.
///
/// Errors of gyro and sensors that the mission file states are states with its prior
/// (unscented_attitude.h); the gyro measures (1 + M) rate + bias.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "pipelines/frames/uncertain_attitude.h"
#include "pipelines/three_axis/alignment.h"
#include "pipelines/three_axis/rate_span.h"
#include "pipelines/three_axis/unscented/measurements.h"
#include "pipelines/three_axis/unscented/unscented_attitude.h"

namespace spindrift {

class Usque {
 public:
  /// @param start Attitude; its covariance may be as large as (60 deg)^2 about each axis.
  /// @param bias_sigma_rad_s Standard deviation of the bias of each axis; its prior mean is 0.
  /// @param alignment Prior covariance of the errors.
  Usque(const UncertainAttitude& start, double bias_sigma_rad_s,
        const AttitudeAlignment& alignment = AttitudeAlignment::Zero());

  void propagate(const RateSpan& span, const SpanErrors& errors);

  /// @name Innovations
  /// Compares a measurement with the state.
  /// @{
  UnscentedInnovation innovation(const SeenField& field) const;
  UnscentedInnovation innovation(const SeenSun& sun) const;
  UnscentedInnovation innovation(const SeenStars& stars) const;
  /// @}

  void update(const SeenField& field);
  void update(const SeenSun& sun);
  void update(const SeenStars& stars);

  const Eigen::Quaterniond& q_icrf_body() const { return estimate_.q_icrf_body; }
  Eigen::Vector3d bias_rad_s() const { return estimate_.state.segment<3>(Bias); }

  /// Returns the total covariance of turn (rad) and bias (rad/s).
  Eigen::Matrix<double, 6, 6> covariance() const {
    return estimate_.covariance.topLeftCorner<6, 6>();
  }
  Eigen::Matrix3d attitude_covariance_rad2() const {
    return estimate_.covariance.topLeftCorner<3, 3>();
  }
  /// Returns what the covariance of the attitude would be if the mission file were exact.
  Eigen::Matrix3d attitude_noise_rad2() const { return estimate_.attitude_noise_rad2(); }

 private:
  /// First index of the states in front of the errors of the sensors: turn, bias, then M as
  /// AttitudeAlignmentError has it.
  enum State { Turn = 0, Bias = 3, Scale = 6, Axes = 9 };
  static constexpr int kMoving = 15;
  using Estimate = UnscentedAttitude<kMoving, Scale>;

  Eigen::Quaterniond turned(const Eigen::Quaterniond& q_icrf_body, const Estimate::Moving& state,
                            const RateSpan& span) const;
  Eigen::Vector3d rate_rad_s() const;

  Estimate estimate_;
  Eigen::Vector3d measured_rad_s_ = Eigen::Vector3d::Zero();  ///< Latest rate of the gyro.
};

}  // namespace spindrift
