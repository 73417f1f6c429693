/// @file
/// Observability: covariance with the priors, and directions that the edges leave undetermined.

#pragma once

#include <Eigen/Core>
#include <vector>

#include "pipelines/spin/batch/batch_solution.h"
#include "pipelines/spin/batch/pass_information.h"

namespace spindrift {

/// Those that any edge of the pass depends on.
BiasSet seen_biases(const PassInformation& information);

/// The covariance of motion and biases, the priors of the biases included.
class Observability {
 public:
  /// @param estimated The others are known to be what they are in the state.
  Observability(const PassInformation& information, BiasSet estimated);

  using Matrix = Eigen::Matrix<double, kBatchUnknowns, kBatchUnknowns>;
  /// Of all unknowns of pass_model.h; zero beside the diagonal for biases that are known.
  const Matrix& covariance() const { return covariance_; }
  /// Tilts of the frame `spin`, rad^2; where the edges leave a direction open, large.
  Eigen::Matrix2d axis_covariance_rad2() const { return covariance_.topLeftCorner<2, 2>(); }
  Eigen::Matrix2d coning_covariance_rad2() const {
    return covariance_.block<2, 2>(kMotionUnknowns + ConingX, kMotionUnknowns + ConingX);
  }
  /// What offsets of the channels' times, taken for zero, add to it.
  /// @param information Of which it is.
  Eigen::Matrix2d offsets_rad2(const PassInformation& information,
                               const OffsetPrior& offsets_s2) const;
  /// Of the drift of the rate, (rad/s^2)^2. @param half_s Half length of the pass.
  double drift_variance(double half_s) const;
  /// Of the rate at the end of the pass. @param half_s Its half length.
  double last_rate_variance(double half_s) const;

  /// What all unknowns would move by from a state, to the best. Zero for biases that are known.
  /// @param information Of that state; @param biases too.
  Eigen::Matrix<double, kBatchUnknowns, 1> step(const PassInformation& information,
                                                const SensorBiases& biases) const;

  /// What the estimated biases would move by from a state that is the best with others held.
  /// @param information Of that state; @param biases too.
  SensorBiases bias_step(const PassInformation& information, const SensorBiases& biases) const;

  /// Root mean square error of the axis of such a state, rad: where the axis would move to, and
  /// what would be left open then.
  double rms_error_rad(const PassInformation& information, const SensorBiases& biases) const;

  /// Singular values of the whitened equations, in units of the priors (motion: 1 rad), largest
  /// first: below 1 the edges say less of a direction than was known before.
  std::vector<double> singular_values() const;

  /// @param biases Of the state.
  std::vector<BiasEstimate> biases(const SensorBiases& biases) const;

  /// Every direction of the biases that the edges leave open: the biases that take part in it.
  std::vector<BiasSet> undetermined() const;

 private:
  Eigen::MatrixXd of_biases() const;

  std::vector<SensorBias> estimated_;
  Matrix scaled_ = Matrix::Zero();  ///< Information in units of the priors, without them.
  Matrix covariance_ = Matrix::Zero();
};

}  // namespace spindrift
