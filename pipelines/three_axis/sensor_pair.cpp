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
constexpr double kMost = 4.0;
constexpr int kFewestComparisons = 4;
// A contradiction is over when so many comparisons in a row have been nearer than this, in sigma.
constexpr int kEndsAfter = 5;
constexpr double kNear = 1.0;
// A comparison so far off by itself, in sigma, is no noise.
constexpr double kCertain = 20.0;
// Comparisons go on showing the same turn if they are within this share of it.
constexpr double kSteady = 0.15;
constexpr double kLongestSilence_s = 60.0;
// Chi-square with one more degree of freedom exceeds 5 sigma as rarely if it is larger by this.
constexpr double kSquarePerFreedom = 3.4;

/// Makes a singular matrix invertible about the axes that nothing measures.
Matrix3d regular(const Matrix3d& matrix) {
  return matrix + 1e-9 * matrix.trace() * Matrix3d::Identity();
}

double square_of(const Vector3d& score, const Matrix3d& covariance) {
  return score.dot(regular(covariance).llt().solve(score));
}

}  // namespace

double sigmas_from(double square, int freedom) {
  return std::sqrt(std::max(square - kSquarePerFreedom * (freedom - 1), 0.0));
}

void SensorPair::add(TaiTime t, const PairComparison& compared, const PairPrior& prior) {
  forget(t);
  const Vector3d weighted = compared.information * compared.turn_rad;
  const double square = compared.turn_rad.dot(weighted);
  const double share = square > kMost * kMost ? kMost / std::sqrt(square) : 1.0;
  information_ += share * compared.information;
  score_ += share * weighted;
  per_error_ += (share * compared.information).lazyProduct(compared.per_error);
  noise_ += compared.information;
  weighted_squares_ += share * square;
  weighted_freedoms_ += share * compared.freedom;
  squares_ += std::min(square, kMost * kMost);
  freedoms_ += compared.freedom;
  freedom_ = compared.freedom;
  ++count_;
  const double alone = sigmas_alone(compared, prior);
  least_in_a_row_ = far_in_a_row_ == 0 ? alone : std::min(least_in_a_row_, alone);
  far_in_a_row_ = alone >= kContradicts ? far_in_a_row_ + 1 : 0;
  see_steady(t, compared.turn_rad, alone);
  near_in_a_row_ = alone < kNear ? near_in_a_row_ + 1 : 0;
  if (contradicted_ && near_in_a_row_ >= kEndsAfter) {
    *this = {};
    return;
  }
  judge(prior);
  if (far_in_a_row_ >= kFewestComparisons && least_in_a_row_ > sigmas_) {
    sigmas_ = least_in_a_row_;
    turn_rad_ = compared.turn_rad;
  }
  if (sigmas_ >= kContradicts && count_ >= kFewestComparisons) {
    contradicted_ = t;
  }
}

void SensorPair::see_steady(TaiTime t, const Vector3d& turn_rad, double alone) {
  const Vector3d change_rad = turn_rad - steady_turn_rad_;
  const bool goes_on = change_rad.norm() <= kSteady * steady_turn_rad_.norm();
  steady_ = alone < kCertain ? 0 : goes_on ? steady_ + 1 : 1;
  steady_turn_rad_ = steady_ > 1 ? steady_turn_rad_ + change_rad / steady_ : turn_rad;
  steady_since_ = steady_ > 1 ? steady_since_ : t;
}

Vector3d SensorPair::lasting_turn_rad() const {
  return is_steady() ? steady_turn_rad_ : mean_turn_rad();
}

double SensorPair::lasting_s() const {
  return is_steady() ? std::min(elapsed_s(steady_since_, *last_), kRecent_s) : kRecent_s;
}

bool SensorPair::is_steady() const { return steady_ >= kFewestComparisons; }

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
  weighted_squares_ *= left;
  weighted_freedoms_ *= left;
  squares_ *= left;
  freedoms_ *= left;
}

/// Scatter above the stated noise counts as noise, unless it is as large as `kMost`.
Matrix3d SensorPair::noise_covariance() const {
  const double about_mean = (weighted_squares_ - score_.dot(mean_turn_rad())) / weighted_freedoms_;
  return std::max(std::min(squares_ / freedoms_, about_mean), 1.0) * noise_;
}

Matrix3d SensorPair::covariance(const PairPrior& prior) const {
  const TurnPerPairError by_prior = per_error_.lazyProduct(prior);
  return noise_covariance() + by_prior.lazyProduct(per_error_.transpose());
}

double SensorPair::sigmas_alone(const PairComparison& compared, const PairPrior& prior) const {
  const Vector3d score = compared.information * compared.turn_rad;
  const double by_noise = sigmas_from(score.dot(compared.turn_rad), compared.freedom);
  if (by_noise < kContradicts) {
    return by_noise;
  }
  const TurnPerPairError per_error = compared.information.lazyProduct(compared.per_error);
  const TurnPerPairError by_prior = per_error.lazyProduct(prior);
  const Matrix3d covariance = compared.information + by_prior.lazyProduct(per_error.transpose());
  return sigmas_from(square_of(score, covariance), compared.freedom);
}

/// The errors of the mission file only make a difference less significant.
void SensorPair::judge(const PairPrior& prior) {
  turn_rad_ = mean_turn_rad();
  sigmas_ = sigmas_from(square_of(score_, noise_covariance()), freedom_);
  if (sigmas_ > kAgrees) {
    sigmas_ = sigmas_from(square_of(score_, covariance(prior)), freedom_);
  }
}

bool SensorPair::contradicts(TaiTime now) const {
  return contradicted_ && elapsed_s(*contradicted_, now) <= kRecent_s;
}

bool SensorPair::is_tested(TaiTime now) const {
  return count_ >= kFewestComparisons && elapsed_s(*last_, now) <= kLongestSilence_s;
}

Vector3d SensorPair::mean_turn_rad() const { return regular(information_).llt().solve(score_); }

/// The turn is known only as well as its own pair shows it, so that the least that any turn which
/// this pair admits would be counts: d' A (A + M)^-1 M d with the weights A and M of the pairs.
double SensorPair::sigmas_if(const Vector3d& turn_rad, const Matrix3d& known,
                             const PairPrior& prior) const {
  const Matrix3d own = weight(prior);
  const Vector3d shared = regular(known + own).llt().solve(own * turn_rad);
  return std::sqrt(std::max(turn_rad.dot(known * shared), 0.0));
}

Matrix3d SensorPair::weight(const PairPrior& prior) const {
  return information_ * regular(covariance(prior)).llt().solve(information_);
}

}  // namespace spindrift
