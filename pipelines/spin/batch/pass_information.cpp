#include "pipelines/spin/batch/pass_information.h"

#include <algorithm>
#include <cmath>

#include "pipelines/spin/batch/bias_priors.h"
#include "pipelines/statistics/distributions.h"

namespace spindrift {
namespace {

// Noise as stated exceeds the limit in one fit of a million. This chance is separate from the
// sigmas of significance.h because this limit follows the skewness of the chi-square and so
// holds for the few edges of a part of a pass too. Results depend on it; kContradictionChance would
// be 4.86 sigmas instead of 4.75.
const double kSignificantSigmas = normal_beyond(1e-6);

}  // namespace

PassInformation& PassInformation::operator+=(const PassInformation& other) {
  information += other.information;
  score += other.score;
  considered += other.considered;
  squares += other.squares;
  edges += other.edges;
  outliers += other.outliers;
  return *this;
}

double PassInformation::outlier_share() const {
  return static_cast<double>(outliers) / static_cast<double>(edges + outliers);
}

double PassInformation::misfit() const {
  return squares + static_cast<double>(outliers) * kOutlierSigmas * kOutlierSigmas;
}

double PassInformation::excess_noise(int unknowns) const {
  const auto freedom = static_cast<double>(edges - unknowns);
  if (!(freedom > 0.0)) {
    return 1.0;
  }
  // Cornish-Fisher quantile up to the skewness; the actual chance is twice the nominal one at one
  // degree of freedom, 1.3 times at ten.
  const double limit = freedom + kSignificantSigmas * std::sqrt(2.0 * freedom) +
                       kSignificantSigmas * kSignificantSigmas * 2.0 / 3.0;
  return squares > limit ? squares / freedom : 1.0;
}

PassInformation PassInformation::less_considered(const ConsideredPrior& prior) const {
  PassInformation less = *this;
  less.squares -= considered.eliminate(prior, less.information, less.score);
  less.considered = {};
  return less;
}

PassInformation information_of(const PassModel& model, std::span<const PassEdge> edges,
                               const SpinState& state, double outlier_sigmas) {
  const PassAtState at = model.at(state);
  const SpinConfig& config = model.config();
  PassInformation sum{.bias_sigmas = BiasPriors{model, state}.of_estimated()};
  for (const PassEdge& edge : edges) {
    const auto residual = at.residual(edge.pulse);
    const double limit = residual ? outlier_sigmas * residual->sigma(config.alignment) : 0.0;
    if (!residual || !(std::abs(residual->off) < limit)) {
      ++sum.outliers;
      continue;
    }
    sum.information.selfadjointView<Eigen::Lower>().rankUpdate(residual->slopes.transpose());
    const double part = residual->off / limit;
    const double weight = (1.0 - part * part) * (1.0 - part * part) / kMeanSlope;
    sum.score += residual->slopes.transpose() * (weight * residual->off);
    PerConsidered considered = PerConsidered::Zero();
    considered(static_cast<Eigen::Index>(edge.pulse.channel)) =
        1.0 / edge_sigma_s(config.noise, edge.pulse.channel);
    considered.tail<kSpinAlignmentErrors>() = residual->per_alignment;
    sum.considered.shared += residual->slopes.transpose() * considered;
    sum.considered.own.selfadjointView<Eigen::Lower>().rankUpdate(considered.transpose());
    sum.considered.score += considered.transpose() * (weight * residual->off);
    sum.squares += residual->off * residual->off;
    ++sum.edges;
  }
  sum.information = Eigen::Matrix<double, kBatchUnknowns, kBatchUnknowns>{
      sum.information.selfadjointView<Eigen::Lower>()};
  sum.considered.own = ConsideredPrior{sum.considered.own.selfadjointView<Eigen::Lower>()};
  return sum;
}

std::vector<SpanInformation> information_by_span(const PassModel& model,
                                                 std::span<const PassEdge> edges,
                                                 const SpinState& state, std::size_t spans) {
  std::vector<SpanInformation> all;
  const std::size_t most = std::min(spans, edges.size());
  for (std::size_t i = 0; i < most; ++i) {
    const std::size_t first = i * edges.size() / most;
    const std::size_t end = (i + 1) * edges.size() / most;
    all.push_back({.begin = edges[first].pulse.t,
                   .first_edge = first,
                   .of = information_of(model, edges.subspan(first, end - first), state)});
  }
  return all;
}

}  // namespace spindrift
