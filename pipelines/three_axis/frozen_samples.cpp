#include "pipelines/three_axis/frozen_samples.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

namespace spindrift {
namespace {

/// Returns the greatest step of which both values are multiples, by Euclid's algorithm.
double common_step(double a, double b) {
  while (true) {
    const double left = std::abs(std::remainder(std::max(a, b), std::min(a, b)));
    // Decimal rounding may put a change off a multiple of the step by this fraction of the step.
    if (left <= 0.05 * std::min(a, b)) {
      return std::min(a, b);
    }
    a = std::min(a, b);
    b = left;
  }
}

}  // namespace

void FrozenSamples::learn(const Values& earlier, const Values& later) {
  if (steps_.size() == 0) {
    steps_ = Values::Zero(later.size());
  }
  for (Eigen::Index i = 0; i < later.size(); ++i) {
    const double change = std::abs(later[i] - earlier[i]);
    if (change == 0.0) {
      continue;
    }
    if (is_gyro_) {
      steps_[i] = steps_[i] > 0.0 ? std::min(steps_[i], change) : change;
    } else {
      steps_.setConstant(steps_[i] > 0.0 ? common_step(steps_[i], change) : change);
    }
  }
}

int FrozenSamples::repeated(const Values& values, double noise) {
  // A value that never changed is assumed to have the finest step of all values.
  const double finest = finest_step();
  Values steps = Values::Constant(values.size(), finest);
  if (steps_.size() > 0) {
    steps = (steps_.array() > 0.0).select(steps_, finest);
  }
  in_a_row_.resize(is_gyro_ ? static_cast<std::size_t>(values.size()) + 1 : 1);
  repeats_ = 0;
  for (std::size_t row = 0; row < in_a_row_.size(); ++row) {
    const Eigen::Index first = row == 0 ? 0 : static_cast<Eigen::Index>(row) - 1;
    const Eigen::Index count = row == 0 ? values.size() : 1;
    const bool same =
        last_.size() > 0 && values.segment(first, count) == last_.segment(first, count);
    in_a_row_[row] = same ? in_a_row_[row] + 1 : 1;
    const double longest = same ? longest_by_chance(steps.segment(first, count), noise) : 0.0;
    if (same && in_a_row_[row] > longest && in_a_row_[row] > repeats_) {
      repeats_ = in_a_row_[row];
      most_by_chance_ = longest;
    }
  }
  last_ = values;
  return repeats_;
}

int FrozenSamples::learn_and_test(const Values& values, double noise) {
  if (last_.size() > 0) {
    learn(last_, values);
  }
  return repeated(values, noise);
}

/// Returns 0 if no value ever changed.
double FrozenSamples::finest_step() const {
  double finest = 0.0;
  for (const double step : steps_) {
    if (step > 0.0 && (finest == 0.0 || step < finest)) {
      finest = step;
    }
  }
  return finest;
}

double FrozenSamples::step() const { return steps_.size() > 0 ? steps_.maxCoeff() : 0.0; }

/// Two samples repeat by chance if two normally distributed values fall on the same step.
double FrozenSamples::longest_by_chance(const Values& steps, double noise) const {
  double chance = 1.0;
  for (const double step : steps) {
    // Factor by which a sensor may be quieter than stated.
    chance *= std::min(step * 3.0 / (2.0 * noise * std::sqrt(std::numbers::pi)), 1.0);
  }
  if (chance >= 1.0) {
    return std::numeric_limits<double>::infinity();
  }
  if (chance == 0.0) {
    return fewest_.unknown - 1.0;
  }
  return std::max(1.0 + std::log(1e-9) / std::log(chance), fewest_.known - 1.0);
}

}  // namespace spindrift
