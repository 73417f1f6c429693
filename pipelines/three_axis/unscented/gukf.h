/// @file
/// Unscented filter of attitude and rate without a gyro: the body moves by Euler's equations with
/// the momentum of its wheels, and any vectors are measured; the magnetometer alone is enough.
///
/// States besides attitude and rate, each with a prior, are a constant torque, the logarithms of
/// the three principal moments, and the errors of the sensors (unscented_attitude.h). What has the
/// prior 0 is no state: the mission file decides what the filter estimates.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>

#include "pipelines/frames/body_state.h"
#include "pipelines/frames/uncertain_attitude.h"
#include "pipelines/ground_model/dynamics/rigid_body.h"
#include "pipelines/three_axis/alignment.h"
#include "pipelines/three_axis/unscented/measurements.h"
#include "pipelines/three_axis/unscented/unscented_attitude.h"

namespace spindrift {

/// What the mission file says of the body.
struct GukfModel {
  Eigen::Matrix3d inertia_kg_m2;  ///< A body can have it (is_inertia).
  /// Prior covariance of the errors of inertia and sensors; zero where the file counts as exact.
  AttitudeAlignment alignment = AttitudeAlignment::Zero();
  /// Prior standard deviation of a constant torque along each body axis; 0: none.
  double torque_sigma_nm = 0.0;
  /// Square root of the density of a torque without memory, along each body axis.
  double torque_noise_nm_rts = 1e-6;
};

/// Attitude and rate that a filter starts from, and the covariance of their error: turn (rad) and
/// rate (rad/s), body axes.
struct UncertainMotion {
  BodyState motion;
  Eigen::Matrix<double, 6, 6> covariance;
};

/// Returns the motion at the second of two attitudes, as from pairs of vectors, with independent
/// errors. The rate is taken for constant between them, with an error of what it may turn.
/// @param dt_s Time between the two, in which the body turns by less than half a turn.
UncertainMotion motion_between(const UncertainAttitude& first, const UncertainAttitude& second,
                               double dt_s);

class Gukf {
 public:
  Gukf(const GukfModel& model, const UncertainMotion& start);

  /// Returns a filter that starts again at the estimated moments, with their prior covariance.
  Gukf started_again(const GukfModel& model, const UncertainMotion& start) const;

  /// @param torques Known torques and momentum of the wheels at the start of the step.
  /// @param position_icrf_km Where the Earth's gravity turns the body, in the middle of the step;
  ///        empty: it does not.
  void propagate(double dt_s, const BodyTorques& torques = {},
                 const std::optional<Eigen::Vector3d>& position_icrf_km = std::nullopt);

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
  Eigen::Vector3d rate_rad_s() const { return estimate_.state.segment<3>(Rate); }
  Eigen::Vector3d torque_nm() const { return estimate_.state.segment<3>(Torque); }
  /// Returns the estimated logarithms of the principal moments by those of the file, ascending.
  Eigen::Vector3d log_moments() const { return estimate_.state.segment<3>(LogMoments); }
  Eigen::Vector3d field_bias_nt() const { return estimate_.state.segment<3>(kMoving + FieldBias); }

  /// Returns the total covariance of turn (rad) and rate (rad/s).
  Eigen::Matrix<double, 6, 6> covariance() const {
    return estimate_.covariance.topLeftCorner<6, 6>();
  }
  Eigen::Matrix3d attitude_covariance_rad2() const {
    return estimate_.covariance.topLeftCorner<3, 3>();
  }
  /// Returns what the covariance of the attitude would be if the mission file were exact.
  Eigen::Matrix3d attitude_noise_rad2() const { return estimate_.attitude_noise_rad2(); }
  Eigen::Matrix3d torque_covariance_nm2() const {
    return estimate_.covariance.block<3, 3>(Torque, Torque);
  }
  Eigen::Matrix3d log_moments_covariance() const {
    return estimate_.covariance.block<3, 3>(LogMoments, LogMoments);
  }
  Eigen::Matrix3d field_bias_covariance_nt2() const {
    return estimate_.covariance.block<3, 3>(kMoving + FieldBias, kMoving + FieldBias);
  }

  /// Returns the largest estimated error of the mission file, in standard deviations of its prior.
  double most_prior_sigmas() const;

 private:
  /// First index of the states in front of the errors of the sensors.
  enum State { Turn = 0, Rate = 3, Torque = 6, LogMoments = 9 };
  static constexpr int kMoving = 12;
  using Estimate = UnscentedAttitude<kMoving, LogMoments>;

  /// What acts on the body in a span of time.
  struct Step {
    double dt_s;
    BodyTorques torques;
    std::optional<Eigen::Vector3d> position_icrf_km;
    int parts;  ///< Number of steps of the integration.
  };
  BodyState after(const Eigen::Quaterniond& q_icrf_body, const Estimate::Moving& state,
                  const Step& step) const;
  void add_noise(double dt_s);

  Eigen::Matrix3d principal_axes_;  ///< Columns in body axes, moments ascending.
  Eigen::Vector3d moments_kg_m2_;   ///< Those of the file.
  double torque_noise2_;            ///< Density, N^2 m^2 s.
  Estimate estimate_;
  Estimate::State prior_sigma_;  ///< Zero where a state is exact.
};

}  // namespace spindrift
