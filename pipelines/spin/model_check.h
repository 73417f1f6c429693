/// @file
/// Whether the measurements of a pass agree with each other. A revolution measures up to five
/// angles and the axis has two: what is left over averages to zero if the models of sensors and
/// Earth are right, and where it does not, their errors have moved the mean of the axes as well.
///
/// With the residuals r against any axis near, their slopes H by the axis and B by the errors of
/// the model, and the noise R of a revolution, the pass is one least-squares problem r = H x + B b.
/// The axis x eliminated, the errors b have the information L and the score s, whose covariance is
/// L if all b are zero: s.L^-1 s then is a chi-square with as many degrees of freedom as L has
/// directions that the pass can see. Directions that it cannot see, it cannot test.

#pragma once

#include <Eigen/Core>
#include <utility>

#include "pipelines/spin/config.h"
#include "pipelines/spin/measurement.h"
#include "pipelines/spin/model_allowance.h"
#include "pipelines/spin/sightlines.h"

namespace spindrift {

/// What the residuals say of noise and model.
struct ModelVerdict {
  /// How many times their variance is what the stated noise makes it, where significantly more than
  /// 1; else 1.
  double excess_noise = 1.0;
  /// How wrong each of the model's errors may be: its standard deviation, taken alike for all, at
  /// the upper end of what the residuals leave open; 0 where they show none.
  double error_rad = 0.0;
  /// Mean products of the errors: what is seen of them, and error_rad for the rest of them.
  Eigen::Matrix<double, kModelErrors, kModelErrors> errors_rad2 =
      Eigen::Matrix<double, kModelErrors, kModelErrors>::Zero();
  /// The errors are more than kModelError_rad accounts for.
  bool beyond_allowance = false;
};

/// @param excess_noise How many times their variance is what the stated noise makes it.
/// @param allowed_rad One standard deviation of errors that are known of, and no contradiction.
ModelVerdict verdict_on(const ErrorInformation& errors, double excess_noise, double allowed_rad);

class ModelCheck {
 public:
  explicit ModelCheck(SpinConfig config) : config_{std::move(config)} {}

  /// @param axis_icrf Unit; so near the true one that the angles are linear in between.
  void add(const RevolutionMeasurements& measured, const Sightlines& sightlines,
           const Eigen::Vector3d& axis_icrf);

  /// @param allowed_rad As `verdict_on`.
  ModelVerdict verdict(double allowed_rad) const;

 private:
  static constexpr int kUnknowns = 2 + kModelErrors;

  double excess_noise() const;

  SpinConfig config_;
  Eigen::Vector3d reference_icrf_ = Eigen::Vector3d::Zero();  ///< Where x counts from.
  /// Normal equations of x and b.
  Eigen::Matrix<double, kUnknowns, kUnknowns> normal_ =
      Eigen::Matrix<double, kUnknowns, kUnknowns>::Zero();
  Eigen::Matrix<double, kUnknowns, 1> right_ = Eigen::Matrix<double, kUnknowns, 1>::Zero();
  double squares_ = 0.0;  ///< r.R^-1 r
  int angles_ = 0;
};

}  // namespace spindrift
