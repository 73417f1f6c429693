/// @file
/// Covariance with the priors, and the directions that the edges leave undetermined.

#pragma once

#include <Eigen/Core>
#include <vector>

#include "pipelines/spin/batch/batch_solution.h"
#include "pipelines/spin/batch/pass_information.h"

namespace spindrift {

/// Returns the biases that any edge of the pass depends on.
BiasSet seen_biases(const PassInformation& information);

/// Holds the covariance of motion and biases, including the priors of the biases.
class Observability {
 public:
  /// @param estimated Biases to estimate; the others are taken as known.
  Observability(const PassInformation& information, BiasSet estimated);

  using Matrix = Eigen::Matrix<double, kBatchUnknowns, kBatchUnknowns>;
  /// Covariance of all unknowns of pass_model.h; off-diagonals of known biases are zero.
  const Matrix& covariance() const { return covariance_; }
  /// Covariance of the tilts of the frame `spin`, rad^2; large where the edges leave a direction
  /// open.
  Eigen::Matrix2d axis_covariance_rad2() const { return covariance_.topLeftCorner<2, 2>(); }
  Eigen::Matrix2d coning_covariance_rad2() const {
    return covariance_.block<2, 2>(kMotionUnknowns + ConingX, kMotionUnknowns + ConingX);
  }
  /// Returns true unknowns minus these per considered parameter; zero of known biases.
  /// @param information Equations that this object was made from.
  Eigen::Matrix<double, kBatchUnknowns, kSpinConsidered> moved(
      const PassInformation& information) const;
  /// Returns the covariance of all unknowns that considered parameters add.
  /// @param information Equations that this object was made from.
  Matrix considered(const PassInformation& information, const ConsideredPrior& prior) const;
  /// Returns the information on considered parameters that the unknowns take up.
  ConsideredPrior taken(const PassInformation& information) const;

  /// Returns the step of all unknowns from a state to the best one; zero for known biases.
  /// @param information Equations at that state. @param biases Biases of that state.
  Eigen::Matrix<double, kBatchUnknowns, 1> step(const PassInformation& information,
                                                const SensorBiases& biases) const;

  /// Returns the step of the estimated biases from a state that is the best with other biases held.
  /// @param information Equations at that state. @param biases Biases of that state.
  SensorBiases bias_step(const PassInformation& information, const SensorBiases& biases) const;

  /// Returns the singular values of the whitened equations in units of the priors (motion: 1 rad),
  /// largest first. Below 1 the edges say less about a direction than the prior.
  std::vector<double> singular_values() const;

  /// @param considered Part of the covariance of all unknowns that considered parameters add.
  std::vector<BiasEstimate> biases(const SensorBiases& biases,
                                   const Matrix& considered = Matrix::Zero()) const;

  /// Returns the biases that take part in each bias direction that the edges leave open.
  std::vector<BiasSet> undetermined() const;

 private:
  Eigen::MatrixXd of_biases() const;

  std::vector<SensorBias> estimated_;
  SensorBiases sigmas_;
  Matrix scaled_ = Matrix::Zero();  ///< Information without the priors, in their units.
  Matrix covariance_ = Matrix::Zero();
};

/// Returns the variance of the rate drift, (rad/s^2)^2, from the covariance of all unknowns.
/// @param half_s Half length of the pass.
double drift_variance(const Observability::Matrix& covariance, double half_s);
/// Returns the variance of the rate at the end of the pass, likewise.
double last_rate_variance(const Observability::Matrix& covariance, double half_s);

}  // namespace spindrift
