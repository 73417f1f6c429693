#include "pipelines/spin/batch/bias_choice.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

#include "pipelines/spin/batch/observability.h"
#include "pipelines/statistics/distributions.h"

namespace spindrift {
namespace {

// Nine biases are tested: chi-squares with one degree of freedom, two for coning.
constexpr double kChance = 1.2e-5;
const double kWanted = chi_square_beyond(kChance, 1.0);
const double kConingWanted = chi_square_beyond(kChance, 2.0);

using Unknowns = Eigen::Matrix<double, kBatchUnknowns, 1>;

/// Returns the biases not in `estimated`; ConingX stands for both unknowns of coning.
std::vector<SensorBias> not_among(BiasSet estimated) {
  std::vector<SensorBias> biases;
  for (int i = 0; i < kSensorBiases; ++i) {
    if (!estimated[static_cast<std::size_t>(i)] && i != ConingY) {
      biases.push_back(static_cast<SensorBias>(i));
    }
  }
  return biases;
}

/// Holds the step that all unknowns take when one more bias is estimated.
struct Step {
  Unknowns unknowns;
  double gain;
  double share_of_prior;  ///< Ratio of the bias's sigma to its prior sigma.
};

Step step_with(const PassInformation& pass, BiasSet estimated, SensorBias bias) {
  const BiasSet added = unknowns_of(bias);
  const Observability together{pass, estimated | added};
  // At the best state only the added bias has a nonzero score.
  Unknowns score = Unknowns::Zero();
  std::vector<int> rows;
  double prior_volume = 1.0;
  for (int i = 0; i < kSensorBiases; ++i) {
    if (added[static_cast<std::size_t>(i)]) {
      const int row = kMotionUnknowns + i;
      rows.push_back(row);
      score[row] = pass.score[row];
      prior_volume *= prior_of(static_cast<SensorBias>(i)).sigma;
    }
  }
  const Unknowns unknowns = -together.covariance() * score;
  const Eigen::MatrixXd own = together.covariance()(rows, rows);
  return {.unknowns = unknowns,
          .gain = -score.dot(unknowns),
          .share_of_prior = std::sqrt(own.determinant()) / prior_volume};
}

}  // namespace

double significance_gain(SensorBias bias) { return bias == ConingX ? kConingWanted : kWanted; }

std::vector<BiasGain> significant_biases(const PassInformation& information, BiasSet estimated) {
  const double excess_noise =
      information.excess_noise(kMotionUnknowns + static_cast<int>(estimated.count()));
  std::vector<BiasGain> wanted;
  for (const SensorBias bias : not_among(estimated)) {
    const double gain = step_with(information, estimated, bias).gain / excess_noise;
    if (gain > significance_gain(bias)) {
      wanted.push_back({.bias = bias, .gain = gain});
    }
  }
  const auto beyond = [](const BiasGain& one) { return one.gain - significance_gain(one.bias); };
  std::stable_sort(wanted.begin(), wanted.end(), [&](const BiasGain& one, const BiasGain& other) {
    return beyond(one) > beyond(other);
  });
  return wanted;
}

std::optional<BiasGain> most_significant_bias(const PassInformation& information,
                                              BiasSet estimated) {
  const std::vector<BiasGain> wanted = significant_biases(information, estimated);
  return wanted.empty() ? std::nullopt : std::optional{wanted.front()};
}

Eigen::Matrix2d other_biases_rad2(const PassInformation& information, BiasSet estimated,
                                  SensorBias chosen) {
  const Step with_chosen = step_with(information, estimated, chosen);
  Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
  double weights = 0.0;
  for (const SensorBias bias : not_among(estimated)) {
    const Step other = step_with(information, estimated, bias);
    // The chosen bias fits best, whatever a single step says.
    const double behind = std::max(with_chosen.gain - other.gain, 0.0);
    const double weight = std::exp(-0.5 * behind) * other.share_of_prior;
    const Eigen::Vector2d apart_rad = (other.unknowns - with_chosen.unknowns).head<2>();
    squares += weight * apart_rad * apart_rad.transpose();
    weights += weight;
  }
  return squares / weights;
}

}  // namespace spindrift
