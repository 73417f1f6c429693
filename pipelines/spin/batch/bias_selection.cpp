#include "pipelines/spin/batch/bias_selection.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "pipelines/spin/batch/bias_choice.h"

namespace spindrift {
namespace {

constexpr int kMostBiases = 3;
// A one-step gain may be off by this factor; each comparison of biases costs a fit.
constexpr double kOneStep = 0.7;
constexpr std::size_t kMostRivals = 3;

/// Returns the cost of a fit: misfit, priors, and how easily the added bias explains noise.
double cost_of(const EvaluatedFit& with, SensorBias bias) {
  double cost = with.misfit() + significance_gain(bias);
  for (int i = 0; i < kSensorBiases; ++i) {
    cost += std::pow(with.fit.state.biases[i] / prior_of(static_cast<SensorBias>(i)).sigma, 2);
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

}  // namespace

Expected<BiasSelection> select_biases(const PassModel& model, std::span<const PassEdge> edges,
                                      EvaluatedFit without) {
  BiasSelection added{.best = std::move(without), .open_rad2 = Eigen::Matrix2d::Zero()};
  for (int i = 0; i < kMostBiases; ++i) {
    const EvaluatedFit& now = added.best;
    const auto wanted = significant_biases(now.beside_offsets(), now.estimated);
    if (wanted.empty()) {
      break;
    }
    auto likeliest = likeliest_of(model, edges, now, wanted);
    if (!likeliest) {
      return Unexpected{likeliest.error()};
    }
    added.open_rad2 += other_biases_rad2(now.beside_offsets(), now.estimated, likeliest->first);
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
