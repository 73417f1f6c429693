#include "pipelines/spin/batch/bias_selection.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <utility>

#include "pipelines/spin/batch/observability.h"
#include "pipelines/statistics/distributions.h"

namespace spindrift {
namespace {

using Unknowns = Eigen::Matrix<double, kBatchUnknowns, 1>;

constexpr int kMostBiases = 3;
// A one-step gain may be off by this factor; each comparison of biases costs a fit.
constexpr double kOneStep = 0.7;
constexpr std::size_t kMostRivals = 3;

/// Returns the cost of a fit: misfit, priors, and how easily the added bias explains noise.
double cost_of(const EvaluatedFit& with, SensorBias bias) {
  double cost = with.misfit() + significance_gain(bias);
  for (int i = 0; i < kSensorBiases; ++i) {
    cost += std::pow(with.fit.state.biases[i] / with.information.bias_sigmas[i], 2);
  }
  return cost;
}

/// Returns the biases to compare by full fits: those whose one-step gain, which is inexact, is near
/// the largest, and coning, for which one step is worse because it moves the axis by degrees.
std::vector<SensorBias> competing_biases(std::span<const BiasGain> wanted, BiasSet estimated) {
  std::vector<SensorBias> rivals;
  for (const auto& [bias, gain] : wanted.first(std::min(wanted.size(), kMostRivals))) {
    if (gain > kOneStep * wanted.front().gain) {
      rivals.push_back(bias);
    }
  }
  if (!estimated[ConingX] && std::find(rivals.begin(), rivals.end(), ConingX) == rivals.end()) {
    rivals.push_back(ConingX);
  }
  return rivals;
}

Expected<std::pair<SensorBias, EvaluatedFit>> likeliest_of(const PassModel& model,
                                                           std::span<const PassEdge> edges,
                                                           const EvaluatedFit& now,
                                                           std::span<const BiasGain> wanted) {
  std::optional<std::pair<SensorBias, EvaluatedFit>> best;
  for (const SensorBias bias : competing_biases(wanted, now.estimated)) {
    auto with = explain(model, edges, now.fit.state, now.estimated | unknowns_of(bias));
    if (!with) {
      return Unexpected{with.error()};
    }
    with->nutation = now.nutation;
    if (!best || cost_of(*with, bias) < cost_of(best->second, best->first)) {
      best = {bias, *std::move(with)};
    }
  }
  return *std::move(best);
}

// Nine biases are tested: chi-squares with one degree of freedom, two for coning.
constexpr double kChance = 1.2e-5;
const double kWanted = chi_square_beyond(kChance, 1.0);
const double kConingWanted = chi_square_beyond(kChance, 2.0);

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
      prior_volume *= pass.bias_sigmas[i];
    }
  }
  const Unknowns unknowns = -together.covariance() * score;
  const Eigen::MatrixXd own = together.covariance()(rows, rows);
  return {.unknowns = unknowns,
          .gain = -score.dot(unknowns),
          .share_of_prior = std::sqrt(own.determinant()) / prior_volume};
}

}  // namespace

double significance_gain() { return kWanted; }

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

Expected<BiasSelection> select_biases(const PassModel& model, std::span<const PassEdge> edges,
                                      EvaluatedFit without) {
  BiasSelection added{.best = std::move(without), .open_rad2 = Eigen::Matrix2d::Zero()};
  for (int i = 0; i < kMostBiases; ++i) {
    const EvaluatedFit& now = added.best;
    const auto wanted = significant_biases(now.beside_considered(), now.estimated);
    if (wanted.empty()) {
      break;
    }
    auto likeliest = likeliest_of(model, edges, now, wanted);
    if (!likeliest) {
      return Unexpected{likeliest.error()};
    }
    added.open_rad2 += other_biases_rad2(now.beside_considered(), now.estimated, likeliest->first);
    if (likeliest->first == ConingX) {
      // A misplaced sensor that no modelled bias describes looks like coning, and then the axis is
      // off by about the coning angle in any direction.
      added.open_rad2 += likeliest->second.fit.state.biases.segment<2>(ConingX).squaredNorm() *
                         Eigen::Matrix2d::Identity();
    }
    added.best = std::move(likeliest->second);
  }
  return added;
}

}  // namespace spindrift
