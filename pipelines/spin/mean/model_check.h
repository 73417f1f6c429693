/// @file
/// Whether the measurements of a pass agree with each other. A revolution measures up to five
/// angles and the axis has two: what is left over averages to zero if the models of sensors and
/// Earth are right, and where it does not, their errors have moved the mean of the axes as well.
///
/// In the equations of the pass, r = H x + B b + noise, the axis x eliminated, the errors b have
/// the information L and the score s, whose covariance is L if all b are zero: s.L^-1 s then is a
/// chi-square with as many degrees of freedom as L has directions that the pass can see. Directions
/// that it cannot see, it cannot test.

#pragma once

#include <Eigen/Core>

#include "pipelines/spin/mean/angle_equations.h"
#include "pipelines/spin/types/model_allowance.h"

namespace spindrift {

/// What the residuals say of noise and model.
struct ModelTest {
  /// How many times their variance is what the stated noise makes it, where significantly more than
  /// 1; else 1.
  double excess_noise = 1.0;
  /// How wrong the worst of the model's errors may be, as a standard deviation at the upper end of
  /// what the residuals leave open; 0 where they show none.
  double error_rad = 0.0;
  /// Mean products of the errors: what is seen of them, and what may be wrong besides.
  Eigen::Matrix<double, kModelErrors, kModelErrors> errors_rad2 =
      Eigen::Matrix<double, kModelErrors, kModelErrors>::Zero();
  /// The errors are more than kModelError_rad accounts for.
  bool beyond_allowance = false;
};

/// @param excess_noise How many times their variance is what the stated noise makes it.
/// @param offsets_s2 What the times of the channels may be off by, which is no error of the model.
ModelTest test_model_errors(const ErrorInformation& errors, double excess_noise,
                            const OffsetPrior& offsets_s2 = OffsetPrior::Zero());

/// @param equations Of axes so near the true one that the angles are linear in between.
/// @param offsets_s2 As `test_model_errors`.
ModelTest test_model(const AngleEquations& equations,
                     const OffsetPrior& offsets_s2 = OffsetPrior::Zero());

}  // namespace spindrift
