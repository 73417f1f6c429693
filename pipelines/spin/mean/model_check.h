/// @file
/// Tests whether the measurements of a pass agree with each other. A revolution measures up to five
/// angles and the axis has two: the residuals average to zero if the models of sensors and Earth
/// are right. If they do not, the model errors have moved the mean axis as well.
///
/// In the equations of the pass, r = H x + B b + noise, with the axis x eliminated, the errors b
/// have the information L and the score s, whose covariance is L if b = 0. Then s.L^-1 s is a
/// chi-square with as many degrees of freedom as L has directions that the pass can see; others are
/// not tested.
///
/// Where the mission file states how far it may be off, such errors are considered first: the test
/// is of what they leave over, and what of that no noise explains is beyond the allowance.

#pragma once

#include <Eigen/Core>
#include <optional>

#include "pipelines/core/assessment.h"
#include "pipelines/spin/mean/angle_equations.h"
#include "pipelines/spin/types/model_allowance.h"

namespace spindrift {

/// Holds the errors of noise and model that the residuals show.
struct ModelTest {
  /// Ratio of the observed to the stated variance where significantly more than 1; else 1.
  double excess_noise = 1.0;
  /// Upper limit of the worst model error as a standard deviation; 0 where the residuals show none.
  double error_rad = 0.0;
  /// Mean products of the model errors: observed part and possible rest.
  Eigen::Matrix<double, kModelErrors, kModelErrors> errors_rad2 =
      Eigen::Matrix<double, kModelErrors, kModelErrors>::Zero();
  /// True when the errors are more than the mission file states, or kModelError_rad accounts for
  /// where it states nothing.
  bool beyond_allowance = false;
  /// The error of the mission file that would explain most; empty where `error_rad` is 0.
  std::optional<SpinAlignmentError> culprit = {};

  /// Returns the reason that says so.
  Reason reason() const;
};

/// @param excess_noise Ratio of the observed to the stated variance.
/// @param prior Prior covariance of the considered parameters, which are no model error.
ModelTest test_model_errors(const ErrorInformation& errors, double excess_noise,
                            const ConsideredPrior& prior = ConsideredPrior::Zero());

/// @param equations Equations at axes so near the true one that the angles are linear in between.
/// @param prior Prior covariance of the considered parameters.
ModelTest test_model(const AngleEquations& equations,
                     const ConsideredPrior& prior = ConsideredPrior::Zero());

/// Accumulates evidence of model errors (misplaced slits or beams, limb altitude) from innovations.
/// Innovations should have zero mean. The part of a model error that looks like another axis moves
/// the axis unseen; the rest stays in the innovations and is tested as above.
class ModelEvidence {
 public:
  /// @param edges Number of edges used.
  void add(const ErrorInformation& errors, double edges);

  /// Reduces the weight of earlier evidence when the filter restarts.
  void fade();

  /// @param excess_noise, prior Arguments of test_model_errors().
  ModelTest test(double excess_noise, const ConsideredPrior& prior) const {
    return test_model_errors(errors_, excess_noise, prior);
  }

 private:
  double edges_ = 0.0;
  ErrorInformation errors_;
};

}  // namespace spindrift
