/// @file
/// The measured angles of many revolutions as one linear least-squares problem,
///
///     r = H x + B b + C c + noise,
///
/// with the residuals r against an axis near the true one, the displacement x of the axis in the
/// tangent plane, the model errors b, the considered parameters c (offsets of the channels' times
/// and errors of the mission file), and the noise of the edges that the angles share. The slopes H
/// and B are those at the axis that the angles are compared with, never at measured values: if an
/// angle's weight depended on its own noise, the mean would be biased.

#pragma once

#include <Eigen/Core>
#include <utility>

#include "pipelines/spin/measurement/measurement.h"
#include "pipelines/spin/types/config.h"
#include "pipelines/spin/types/model_allowance.h"
#include "pipelines/spin/types/sky.h"
#include "pipelines/statistics/considered.h"

namespace spindrift {

class AngleEquations {
 public:
  static constexpr int kUnknowns = 2 + kModelErrors;  ///< The unknowns x, then b.

  /// @param reference_icrf Unit vector that x is counted from.
  explicit AngleEquations(Eigen::Vector3d reference_icrf)
      : reference_icrf_{std::move(reference_icrf)} {}

  /// Adds the good angles of one revolution, except those that are not linear.
  /// @param axis_icrf Unit vector, so near the true axis that the angles are linear in between.
  void add(const SpinConfig& config, const RevolutionMeasurements& measured,
           const SunEarthDirections& sun_earth, const Eigen::Vector3d& axis_icrf);

  /// @param other Equations with the same reference, of other revolutions.
  AngleEquations& operator+=(const AngleEquations& other);

  /// Returns the best-fitting axis without model errors, as a unit vector. A direction that no
  /// angle determines stays at the reference.
  Eigen::Vector3d axis_icrf() const;
  /// Axis covariance in its tangent plane: east, north. An undetermined direction gets one radian.
  Eigen::Matrix2d covariance_rad2() const;
  /// Returns the covariance of the axis for a covariance of its right-hand sides.
  Eigen::Matrix2d scatter_rad2(const Eigen::Matrix2d& of_right) const;
  /// Returns the axis motion per model error, rad/rad, in the tangent plane.
  Eigen::Matrix<double, 2, kModelErrors> model_shift() const;

  /// Returns the axis motion per considered parameter, in the tangent plane.
  Eigen::Matrix<double, 2, kSpinConsidered> considered_shift() const;
  /// Returns the equations of the model errors with the axis eliminated.
  ErrorInformation less_axis() const;

  /// @name The normal equations of x and b
  /// @{
  const Eigen::Matrix<double, kUnknowns, kUnknowns>& normal() const { return normal_; }
  const Eigen::Matrix<double, kUnknowns, 1>& right() const { return right_; }
  double squares() const { return squares_; }  ///< Sum of squares against the reference.
  int angles() const { return angles_; }
  const Considered<kUnknowns, kSpinConsidered>& considered() const { return considered_; }
  /// @}

 private:
  Eigen::Matrix2d axis_information() const;
  Eigen::Matrix2d tangent_from_reference() const;

  Eigen::Vector3d reference_icrf_;
  Eigen::Matrix<double, kUnknowns, kUnknowns> normal_ =
      Eigen::Matrix<double, kUnknowns, kUnknowns>::Zero();
  Eigen::Matrix<double, kUnknowns, 1> right_ = Eigen::Matrix<double, kUnknowns, 1>::Zero();
  double squares_ = 0.0;
  int angles_ = 0;
  Considered<kUnknowns, kSpinConsidered> considered_;
};

}  // namespace spindrift
