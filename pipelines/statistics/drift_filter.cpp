#include "pipelines/statistics/drift_filter.h"

#include <algorithm>
#include <cmath>

#include "pipelines/statistics/significance.h"

namespace spindrift {
namespace {

// Factor by which a deviation beyond the median widens the scale and one within it narrows it.
constexpr double kScaleStep = 1.05;
constexpr double kMostScale = 30.0;

}  // namespace

DriftFilter::DriftFilter(const DriftState& state)
    : x_{state.x},
      state_{state.value, state.change, state.bend},
      covariance_{Eigen::Vector3d{state.value_sigma, state.change_sigma, state.bend_sigma}
                      .cwiseAbs2()
                      .asDiagonal()},
      scale_{std::clamp(state.scale, 1.0, kMostScale)} {}

double DriftFilter::at(double x) const {
  const double ahead = x - x_;
  return state_[0] + (state_[1] + 0.5 * state_[2] * ahead) * ahead;
}

double DriftFilter::x_of(double value) const {
  const double ahead = value - state_[0];
  const double change_squared = state_[1] * state_[1] + 2.0 * state_[2] * ahead;
  if (change_squared < 0.0) {
    return x_ - state_[1] / state_[2];
  }
  return x_ + 2.0 * ahead / (state_[1] + std::sqrt(change_squared));
}

Eigen::Matrix3d DriftFilter::covariance_at(double x, const DriftNoise& noise) const {
  const double ahead = x - x_;
  Eigen::Matrix3d moved = covariance_;
  moved.row(0) += ahead * (moved.row(1) + 0.5 * ahead * moved.row(2));
  moved.row(1) += ahead * moved.row(2);
  moved.col(0) += ahead * (moved.col(1) + 0.5 * ahead * moved.col(2));
  moved.col(1) += ahead * moved.col(2);
  // Process noise integrated over the distance, which counts the same backwards.
  const double length = std::abs(ahead);
  const double change = noise.wander * noise.wander * length;
  const double bend = noise.bend_wander * noise.bend_wander * length;
  const double ahead_2 = ahead * ahead;
  moved(0, 0) += ahead_2 * (change / 3.0 + ahead_2 * bend / 20.0);
  moved(0, 1) += ahead * (change / 2.0 + ahead_2 * bend / 8.0);
  moved(0, 2) += ahead_2 * bend / 6.0;
  moved(1, 1) += change + ahead_2 * bend / 3.0;
  moved(1, 2) += ahead * bend / 2.0;
  moved(2, 2) += bend;
  return moved.selfadjointView<Eigen::Upper>();
}

double DriftFilter::sigma_at(double x, const DriftNoise& noise) const {
  return std::sqrt(covariance_at(x, noise)(0, 0));
}

double DriftFilter::change_sigma_at(double x, const DriftNoise& noise) const {
  // Far back, rounding may leave almost nothing of the variance, or make it negative.
  return std::sqrt(std::max(covariance_(1, 1), covariance_at(x, noise)(1, 1)));
}

DriftTest DriftFilter::test(double x, double measured, const DriftNoise& noise,
                            const DriftGate& gate) const {
  const double sigma = std::hypot(sigma_at(x, noise), scale_ * noise.measured);
  return {
      .off = measured - at(x), .sigma = sigma, .limit = std::min(gate.sigma * sigma, gate.most)};
}

DriftTest DriftFilter::follow(double x, double measured, const DriftNoise& noise,
                              const DriftGate& gate) {
  const DriftTest tested = test(x, measured, noise, gate);
  const double ahead = x - x_;
  if (ahead < 0.0) {  // Earlier measurements are tested but not used.
    return tested;
  }
  const Eigen::Matrix3d before = covariance_at(x, noise);
  const double measured_sigma = scale_ * noise.measured;
  const double variance = before(0, 0) + measured_sigma * measured_sigma;
  const double off = tested.off;
  const bool far = off * off > kMedianDeviation * kMedianDeviation * variance;
  scale_ = std::clamp(far ? scale_ * kScaleStep : scale_ / kScaleStep, 1.0, kMostScale);
  if (tested.passed()) {
    const Eigen::Vector3d gain = before.col(0) / variance;
    state_ = Eigen::Vector3d{at(x), state_[1] + state_[2] * ahead, state_[2]} + gain * off;
    x_ = x;
    // Joseph form: rounding makes no variance negative, however large it was before.
    Eigen::Matrix3d kept = Eigen::Matrix3d::Identity();
    kept.col(0) -= gain;
    covariance_ = kept * before * kept.transpose() +
                  gain * measured_sigma * measured_sigma * gain.transpose();
  }
  return tested;
}

DriftFilter DriftFilter::supposing_bend(double bend, double sigma) const {
  DriftFilter supposed = *this;
  const Eigen::Vector3d gain = covariance_.col(2) / (covariance_(2, 2) + sigma * sigma);
  supposed.state_ += gain * (bend - state_[2]);
  supposed.covariance_ -= gain * covariance_.row(2);
  return supposed;
}

void DriftFilter::loosen(double value_sigma, double change_sigma, double bend_sigma) {
  covariance_.diagonal() += Eigen::Vector3d{value_sigma, change_sigma, bend_sigma}.cwiseAbs2();
}

void DriftFilter::shift(double x, double value, double change) {
  state_[0] += value + change * (x_ - x);
  state_[1] += change;
}

}  // namespace spindrift
