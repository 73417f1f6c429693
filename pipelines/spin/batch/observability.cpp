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
Scales scales(const SensorBiases& sigmas) {
  Scales all = Scales::Ones();
  all.tail<kSensorBiases>() = sigmas;
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

Observability::Observability(const PassInformation& information, BiasSet estimated)
    : sigmas_{information.bias_sigmas} {
  const Scales unit = scales(sigmas_);
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

Eigen::Matrix<double, kBatchUnknowns, kSpinConsidered> Observability::moved(
    const PassInformation& information) const {
  Eigen::Matrix<double, kBatchUnknowns, kSpinConsidered> moved =
      covariance_ * information.considered.shared;
  for (int i = 0; i < kSensorBiases; ++i) {
    if (std::find(estimated_.begin(), estimated_.end(), i) == estimated_.end()) {
      moved.row(kMotionUnknowns + i).setZero();
    }
  }
  return moved;
}

Observability::Matrix Observability::considered(const PassInformation& information,
                                                const ConsideredPrior& prior) const {
  const auto by = moved(information);
  return by * prior * by.transpose();
}

ConsideredPrior Observability::taken(const PassInformation& information) const {
  return information.considered.shared.transpose() * moved(information);
}

double drift_variance(const Observability::Matrix& covariance, double half_s) {
  return covariance(4, 4) * std::pow(2.0 / (half_s * half_s), 2);
}

double last_rate_variance(const Observability::Matrix& covariance, double half_s) {
  // Rate at the middle plus the change by drift over half the pass, from the unknowns as angles.
  const Eigen::Vector2d last{1.0 / half_s, 2.0 / half_s};
  return last.dot(covariance.block<2, 2>(3, 3) * last);
}

Eigen::Matrix<double, kBatchUnknowns, 1> Observability::step(const PassInformation& information,
                                                             const SensorBiases& biases) const {
  Eigen::Matrix<double, kBatchUnknowns, 1> score = information.score;
  score.tail<kSensorBiases>().setZero();
  for (const SensorBias bias : estimated_) {
    const double prior = sigmas_[bias];
    const int row = kMotionUnknowns + bias;
    score[row] = information.score[row] + biases[bias] / (prior * prior);
  }
  return -covariance_ * score;
}

SensorBiases Observability::bias_step(const PassInformation& information,
                                      const SensorBiases& biases) const {
  return step(information, biases).tail<kSensorBiases>();
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

std::vector<BiasEstimate> Observability::biases(const SensorBiases& biases,
                                                const Matrix& considered) const {
  std::vector<BiasEstimate> all;
  for (const SensorBias bias : estimated_) {
    const double prior = sigmas_[bias];
    const int row = kMotionUnknowns + bias;
    const double sigma = std::sqrt(covariance_(row, row) + considered(row, row));
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
