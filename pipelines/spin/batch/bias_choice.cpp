#include "pipelines/spin/batch/bias_choice.h"

#include <Eigen/Dense>
#include <cmath>

namespace spindrift {
namespace {

// Eight biases are looked at, each at a chance of 1.2e-5.
constexpr double kWanted = 19.2;

using Unknowns = Eigen::Matrix<double, kBatchUnknowns, 1>;
using Information = Eigen::Matrix<double, kBatchUnknowns, kBatchUnknowns>;

/// The step that all unknowns take when one more bias is estimated.
struct Step {
  Unknowns unknowns;
  double gain;
  double sigma;  ///< Of the bias.
};

Step step_with(const PassInformation& pass, BiasSet estimated, SensorBias bias) {
  estimated.set(static_cast<std::size_t>(bias));
  Information information = pass.information;
  Unknowns score = pass.score;
  information.diagonal().head<kMotionUnknowns>().array() += 1.0;
  for (int i = 0; i < kSensorBiases; ++i) {
    const int row = kMotionUnknowns + i;
    if (estimated[static_cast<std::size_t>(i)]) {
      const double prior = prior_of(static_cast<SensorBias>(i)).sigma;
      information(row, row) += 1.0 / (prior * prior);
    } else {
      information.row(row).setZero();
      information.col(row).setZero();
      information(row, row) = 1.0;
      score[row] = 0.0;
    }
  }
  const Eigen::LDLT<Information> solver{information};
  const Unknowns by_bias = solver.solve(Unknowns::Unit(kMotionUnknowns + bias));
  const double variance = by_bias[kMotionUnknowns + bias];
  // At the best state only the bias itself has a score left.
  const double bias_score = score[kMotionUnknowns + bias];
  return {.unknowns = -by_bias * bias_score,
          .gain = bias_score * bias_score * variance,
          .sigma = std::sqrt(variance)};
}

}  // namespace

std::optional<BiasGain> most_wanted_bias(const PassInformation& information, BiasSet estimated) {
  const double excess_noise =
      information.excess_noise(kMotionUnknowns + static_cast<int>(estimated.count()));
  std::optional<BiasGain> best;
  for (int i = 0; i < kSensorBiases; ++i) {
    const auto bias = static_cast<SensorBias>(i);
    if (estimated[static_cast<std::size_t>(i)]) {
      continue;
    }
    const double gain = step_with(information, estimated, bias).gain / excess_noise;
    if (gain > kWanted && (!best || gain > best->gain)) {
      best = BiasGain{.bias = bias, .gain = gain};
    }
  }
  return best;
}

Eigen::Matrix2d other_biases_rad2(const PassInformation& information, BiasSet estimated,
                                  SensorBias chosen) {
  const Step with_chosen = step_with(information, estimated, chosen);
  Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
  double weights = 0.0;
  for (int i = 0; i < kSensorBiases; ++i) {
    const auto bias = static_cast<SensorBias>(i);
    if (estimated[static_cast<std::size_t>(i)]) {
      continue;
    }
    const Step other = step_with(information, estimated, bias);
    const double weight =
        std::exp(0.5 * (other.gain - with_chosen.gain)) * other.sigma / prior_of(bias).sigma;
    const Eigen::Vector2d apart_rad = (other.unknowns - with_chosen.unknowns).head<2>();
    squares += weight * apart_rad * apart_rad.transpose();
    weights += weight;
  }
  return squares / weights;
}

}  // namespace spindrift
