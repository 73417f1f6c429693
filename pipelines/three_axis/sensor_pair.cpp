#include "pipelines/three_axis/sensor_pair.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "pipelines/time/time_span.h"

namespace spindrift {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// A comparison further off, in sigma, counts as if it were so far off.
constexpr double kMost = 5.0;
constexpr int kFewestComparisons = 4;
constexpr double kLongestSilence_s = 60.0;
// Chi-square with one more degree of freedom exceeds 5 sigma as rarely if it is larger by this.
constexpr double kSquarePerFreedom = 3.4;
// A contradiction ends below this share of its limit.
constexpr double kEndsAt = 0.8;

/// Makes a singular matrix invertible about the axes that nothing measures.
Matrix3d regular(const Matrix3d& matrix) {
  return matrix + 1e-9 * matrix.trace() * Matrix3d::Identity();
}

}  // namespace

void SensorPair::add(TaiTime t, const PairComparison& compared, const PairPrior& prior) {
  forget(t);
  const Vector3d weighted = compared.information * compared.turn_rad;
  const double square = compared.turn_rad.dot(weighted);
  const double share = square > kMost * kMost ? kMost / std::sqrt(square) : 1.0;
  information_ += share * compared.information;
  score_ += share * weighted;
  per_error_ += (share * compared.information).lazyProduct(compared.per_error);
  noise_ += share * share * compared.information;
  squares_ += std::min(square, kMost * kMost);
  freedoms_ += compared.freedom;
  freedom_ = compared.freedom;
  ++count_;
  judge(prior);
}

void SensorPair::forget(TaiTime t) {
  const double passed_s = last_ ? elapsed_s(*last_, t) : 0.0;
  if (passed_s > kLongestSilence_s) {
    *this = {};
  }
  last_ = t;
  const double left = std::exp(-passed_s / kRecent_s);
  information_ *= left;
  score_ *= left;
  per_error_ *= left;
  noise_ *= left * left;
  squares_ *= left;
  freedoms_ *= left;
}

/// Noise above what is stated counts as noise, unless it is as large as `kMost`.
Matrix3d SensorPair::noise_covariance() const {
  return std::max(squares_ / freedoms_, 1.0) * noise_;
}

Matrix3d SensorPair::covariance(const PairPrior& prior) const {
  const TurnPerPairError by_prior = per_error_.lazyProduct(prior);
  return noise_covariance() + by_prior.lazyProduct(per_error_.transpose());
}

void SensorPair::judge(const PairPrior& prior) {
  const auto sigmas_by = [this](const Matrix3d& covariance) {
    const double square = score_.dot(regular(covariance).llt().solve(score_));
    return std::sqrt(std::max(square - kSquarePerFreedom * (freedom_ - 1), 0.0));
  };
  // The errors of the mission file only make a difference less significant.
  sigmas_ = sigmas_by(noise_covariance());
  if (sigmas_ > kAgrees) {
    sigmas_ = sigmas_by(covariance(prior));
  }
  contradicts_ = sigmas_ >= (contradicts_ ? kEndsAt : 1.0) * kContradicts;
}

bool SensorPair::is_tested(TaiTime now) const {
  return count_ >= kFewestComparisons && elapsed_s(*last_, now) <= kLongestSilence_s;
}

Vector3d SensorPair::turn_rad() const { return regular(information_).llt().solve(score_); }

double SensorPair::sigmas_of(const Vector3d& turn_rad, const PairPrior& prior) const {
  const Vector3d score = information_ * turn_rad;
  return std::sqrt(score.dot(regular(covariance(prior)).llt().solve(score)));
}

}  // namespace spindrift
