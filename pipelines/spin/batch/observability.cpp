#include "pipelines/spin/batch/observability.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "pipelines/statistics/significance.h"
#include "pipelines/statistics/symmetric_eigen.h"

namespace spindrift {
namespace {

using Scales = Eigen::Matrix<double, kBatchUnknowns, 1>;

/// Returns the units of the unknowns: one radian for motion, one prior sigma for a bias.
Scales scales() {
  Scales all = Scales::Ones();
  for (int i = 0; i < kSensorBiases; ++i) {
    all[kMotionUnknowns + i] = prior_of(static_cast<SensorBias>(i)).sigma;
  }
  return all;
}

}  // namespace

BiasSet seen_biases(const PassInformation& information) {
  BiasSet seen;
  for (int i = 0; i < kSensorBiases; ++i) {
    const int row = kMotionUnknowns + i;
    seen[static_cast<std::size_t>(i)] = information.information(row, row) > 0.0;
  }
  return seen;
}

Observability::Observability(const PassInformation& information, BiasSet estimated) {
  const Scales unit = scales();
  scaled_ = unit.asDiagonal() * information.information * unit.asDiagonal();
  Matrix with_priors = scaled_;
  for (int i = 0; i < kSensorBiases; ++i) {
    const int row = kMotionUnknowns + i;
    if (estimated[static_cast<std::size_t>(i)]) {
      estimated_.push_back(static_cast<SensorBias>(i));
      with_priors(row, row) += 1.0;
    } else {
      for (Matrix* const matrix : {&scaled_, &with_priors}) {
        matrix->row(row).setZero();
        matrix->col(row).setZero();
      }
      with_priors(row, row) = 1.0;
    }
  }
  with_priors.diagonal().head<kMotionUnknowns>().array() += 1.0;
  covariance_ =
      unit.asDiagonal() * with_priors.ldlt().solve(Matrix::Identity()).eval() * unit.asDiagonal();
}

Eigen::Matrix2d Observability::offsets_rad2(const PassInformation& information,
                                            const OffsetPrior& offsets_s2) const {
  const Eigen::Matrix<double, 2, kChannelOffsets> moved =
      covariance_.topRows<2>() * information.offsets.shared;
  return moved * offsets_s2 * moved.transpose();
}

double Observability::drift_variance(double half_s) const {
  return covariance_(4, 4) * std::pow(2.0 / (half_s * half_s), 2);
}

double Observability::last_rate_variance(double half_s) const {
  // Rate at the middle plus the change by drift over half the pass, from the unknowns as angles.
  const Eigen::Vector2d last{1.0 / half_s, 2.0 / half_s};
  return last.dot(covariance_.block<2, 2>(3, 3) * last);
}

Eigen::Matrix<double, kBatchUnknowns, 1> Observability::step(const PassInformation& information,
                                                             const SensorBiases& biases) const {
  Eigen::Matrix<double, kBatchUnknowns, 1> score = information.score;
  score.tail<kSensorBiases>().setZero();
  for (const SensorBias bias : estimated_) {
    const double prior = prior_of(bias).sigma;
    const int row = kMotionUnknowns + bias;
    score[row] = information.score[row] + biases[bias] / (prior * prior);
  }
  return -covariance_ * score;
}

SensorBiases Observability::bias_step(const PassInformation& information,
                                      const SensorBiases& biases) const {
  return step(information, biases).tail<kSensorBiases>();
}

double Observability::rms_error_rad(const PassInformation& information,
                                    const SensorBiases& biases) const {
  return std::sqrt(step(information, biases).head<2>().squaredNorm() +
                   axis_covariance_rad2().trace());
}

std::vector<double> Observability::singular_values() const {
  const Eigen::VectorXd squares = symmetric_eigen(scaled_).values;
  std::vector<double> values;
  const auto unknowns = static_cast<Eigen::Index>(kMotionUnknowns + estimated_.size());
  for (Eigen::Index i = 0; i < unknowns; ++i) {
    values.push_back(std::sqrt(std::max(squares[kBatchUnknowns - 1 - i], 0.0)));
  }
  return values;
}

std::vector<BiasEstimate> Observability::biases(const SensorBiases& biases) const {
  std::vector<BiasEstimate> all;
  for (const SensorBias bias : estimated_) {
    const double prior = prior_of(bias).sigma;
    const double sigma = std::sqrt(covariance_(kMotionUnknowns + bias, kMotionUnknowns + bias));
    const bool observable = sigma < kObservableShare * prior;
    all.push_back({.bias = bias,
                   .value = observable ? biases[bias] : 0.0,
                   .sigma = observable ? sigma : prior,
                   .observable = observable,
                   .estimated = true});
  }
  return all;
}

/// Returns the information on the estimated biases, motion eliminated, in units of the priors.
Eigen::MatrixXd Observability::of_biases() const {
  const Eigen::Matrix<double, kMotionUnknowns, kMotionUnknowns> motion =
      scaled_.topLeftCorner<kMotionUnknowns, kMotionUnknowns>() +
      Eigen::Matrix<double, kMotionUnknowns, kMotionUnknowns>::Identity();
  const Eigen::Matrix<double, kMotionUnknowns, kSensorBiases> mixed =
      scaled_.topRightCorner<kMotionUnknowns, kSensorBiases>();
  const Eigen::Matrix<double, kSensorBiases, kSensorBiases> eliminated =
      scaled_.bottomRightCorner<kSensorBiases, kSensorBiases>() -
      mixed.transpose() * motion.ldlt().solve(mixed);
  return eliminated(estimated_, estimated_);
}

std::vector<BiasSet> Observability::undetermined() const {
  const auto count = static_cast<Eigen::Index>(estimated_.size());
  if (count == 0) {
    return {};
  }
  const SymmetricEigen information = symmetric_eigen(of_biases());
  std::vector<BiasSet> all;
  for (Eigen::Index i = 0; i < count && information.values[i] < 1.0; ++i) {
    BiasSet direction;
    for (Eigen::Index j = 0; j < count; ++j) {
      // Component of an open direction above which a bias takes part in it.
      if (std::abs(information.vectors(j, i)) > 0.35) {
        direction |= unknowns_of(estimated_[static_cast<std::size_t>(j)]);
      }
    }
    // Equally open directions come mixed and may consist of the same biases.
    if (std::find(all.begin(), all.end(), direction) == all.end()) {
      all.push_back(direction);
    }
  }
  return all;
}

}  // namespace spindrift
