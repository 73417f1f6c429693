#include "pipelines/spin/drift_filter.h"

#include <algorithm>
#include <cmath>

namespace spindrift {
namespace {

// Half of all Gaussian deviations are less than this many sigmas.
constexpr double kMedianDeviation = 0.6745;
// By so much a deviation beyond that widens the scatter, one within narrows it.
constexpr double kScaleStep = 1.05;
constexpr double kMostScale = 30.0;

}  // namespace

DriftFilter::DriftFilter(const DriftState& state)
    : turn_{static_cast<double>(state.turn)},
      value_{state.value},
      change_{state.change},
      covariance_{.value = state.value_sigma * state.value_sigma,
                  .both = 0.0,
                  .change = state.change_sigma * state.change_sigma},
      scale_{std::clamp(state.scale, 1.0, kMostScale)} {}

DriftFilter::Covariance DriftFilter::covariance_at(double turn, double wander) const {
  const double turns = std::abs(turn - turn_);
  const double wander_2 = wander * wander;
  const auto& [value, both, change] = covariance_;
  return {.value = value + turns * (2.0 * both + turns * (change + wander_2 * turns / 3.0)),
          .both = both + turns * (change + 0.5 * wander_2 * turns),
          .change = change + wander_2 * turns};
}

double DriftFilter::sigma_at(double turn, const DriftNoise& noise) const {
  return std::sqrt(covariance_at(turn, noise.wander).value);
}

bool DriftFilter::accepts(std::int64_t turn, double measured, const DriftNoise& noise,
                          const DriftGate& gate) const {
  const auto turn_d = static_cast<double>(turn);
  const double sigma = std::hypot(sigma_at(turn_d, noise), scale_ * noise.measured);
  return std::abs(measured - at(turn_d)) <= std::min(gate.sigma * sigma, gate.most);
}

bool DriftFilter::follow(std::int64_t turn, double measured, const DriftNoise& noise,
                         const DriftGate& gate) {
  const bool accepted = accepts(turn, measured, noise, gate);
  const auto turn_d = static_cast<double>(turn);
  if (turn_d < turn_) {  // The past is judged, not learnt from.
    return accepted;
  }
  const Covariance before = covariance_at(turn_d, noise.wander);
  const double measured_sigma = scale_ * noise.measured;
  const double variance = before.value + measured_sigma * measured_sigma;
  const double off = measured - at(turn_d);
  const bool far = off * off > kMedianDeviation * kMedianDeviation * variance;
  scale_ = std::clamp(far ? scale_ * kScaleStep : scale_ / kScaleStep, 1.0, kMostScale);
  if (accepted) {
    const double value_gain = before.value / variance;
    const double change_gain = before.both / variance;
    value_ = at(turn_d) + value_gain * off;
    change_ += change_gain * off;
    turn_ = turn_d;
    covariance_ = {.value = (1.0 - value_gain) * before.value,
                   .both = (1.0 - value_gain) * before.both,
                   .change = before.change - change_gain * before.both};
  }
  return accepted;
}

void DriftFilter::shift(double turn, double value, double change) {
  value_ += value + change * (turn_ - turn);
  change_ += change;
}

}  // namespace spindrift
