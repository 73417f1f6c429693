/// @file
/// Propagates the directions of the last seconds with the gyro until two of them give an attitude.

#pragma once

#include <vector>

#include "pipelines/core/expected.h"
#include "pipelines/frames/uncertain_attitude.h"
#include "pipelines/statistics/considered.h"
#include "pipelines/three_axis/attitude_from_vectors.h"
#include "pipelines/three_axis/products.h"
#include "pipelines/three_axis/sensor_errors.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

/// Holds the error about each axis that propagation with the gyro adds to a direction or an
/// attitude, with variance `variance_rad2()`.
struct CarryError {
  double noise_rad2 = 0.0;  ///< Variance of independent errors, which adds up.
  double drift_rad = 0.0;   ///< Drift by the unknown bias, whose turns add up linearly.

  void add(const CarryError& more) {
    noise_rad2 += more.noise_rad2;
    drift_rad += more.drift_rad;
  }
  double variance_rad2() const { return noise_rad2 + drift_rad * drift_rad; }
};

class CarriedDirections {
 public:
  /// Age beyond which a direction propagated with a gyro is dropped.
  static constexpr double kLongest_s = 5.0;

  /// @param alignment Prior covariance of the errors of the mission file.
  explicit CarriedDirections(const FilterAlignment& alignment = FilterAlignment::Zero())
      : alignment_{alignment} {}

  /// Adds a direction, which replaces the previous one of the same sensor.
  void add(const SeenDirection& seen, const Eigen::Vector3d& rate_body_rad_s);

  /// Propagates the directions to `t` by the rotation vector `turned_rad` of the body.
  /// @param longest_s Age beyond which a direction is dropped.
  void turn(TaiTime t, const Eigen::Vector3d& turned_rad, const CarryError& error,
            double longest_s = kLongest_s);

  void forget() { directions_.clear(); }

  /// Estimates the attitude from the directions held.
  /// @return Unobservable if there are fewer than two directions, if they are nearly collinear, or
  ///         if the angle between them contradicts their references beyond noise and errors.
  Expected<SensitiveAttitude> attitude() const;

 private:
  struct Carried {
    SampleKind kind;
    TaiTime t;
    ObservedDirection direction;  ///< In present body axes; `sigma_rad` as measured.
    TurnPerError per_error;       ///< Derivative of the true attitude that it would give.
    CarryError error;
  };
  struct Fit {
    double squares = 0.0;  ///< Chi-square of the misfits.
    TurnPerError per_error = TurnPerError::Zero();
    Considered<3, kFilterErrors> by_errors = {};  ///< The misfits by the errors.
  };
  Fit fit_of(const UncertainAttitude& attitude,
             const std::vector<ObservedDirection>& directions) const;

  FilterAlignment alignment_;
  std::vector<Carried> directions_;  ///< At most one per kind, in the order of kinds.
};

}  // namespace spindrift
