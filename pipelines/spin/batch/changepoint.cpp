#include "pipelines/spin/batch/changepoint.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

namespace spindrift {
namespace {

constexpr std::size_t kSpans = 64;
// The chance of such a chi-square is 1e-10 for five degrees of freedom, at one of 63 places of a
// change, and 1e-13 for the one of the outlier test, at one of 2,016; but outliers come in bursts.
constexpr double kSignificant = 55.0;

using Motion = Eigen::Matrix<double, kMotionUnknowns, kMotionUnknowns>;

/// Returns the gain (twice log likelihood) of fitting these edges by themselves.
double gain_of(const PassInformation& part) {
  const Motion information =
      part.information.topLeftCorner<kMotionUnknowns, kMotionUnknowns>() + Motion::Identity();
  const Eigen::Matrix<double, kMotionUnknowns, 1> score = part.score.head<kMotionUnknowns>();
  return score.dot(information.ldlt().solve(score));
}

bool mostly_outliers(const PassInformation& part) { return part.outlier_share() > kMostOutliers; }

/// Returns twice the log likelihood of the outliers if every edge is one with the same probability.
double evenly(const PassInformation& part) {
  const auto all = static_cast<double>(part.edges + part.outliers);
  double sum = 0.0;
  for (const auto some : {static_cast<double>(part.edges), static_cast<double>(part.outliers)}) {
    sum += some > 0.0 ? 2.0 * some * std::log(some / all) : 0.0;
  }
  return sum;
}

/// Returns the chi-square (one degree of freedom) of different outlier shares before and after.
double contrast(const PassInformation& before, const PassInformation& after) {
  PassInformation both = before;
  both += after;
  return evenly(before) + evenly(after) - evenly(both);
}

/// Finds a change by its outliers: a state that fits one attitude leaves the edges of the other as
/// outliers. The stretch before may begin anywhere, for example at an earlier change.
std::optional<Changepoint> change_to_outliers(const std::vector<SpanInformation>& spans) {
  std::optional<Changepoint> best;
  double clearest = kSignificant;
  PassInformation after;
  for (std::size_t i = spans.size() - 1; i > 0; --i) {
    after += spans[i].of;
    PassInformation before;
    for (std::size_t j = i; j-- > 0;) {
      before += spans[j].of;
      if (mostly_outliers(before) != mostly_outliers(after) && contrast(before, after) > clearest) {
        clearest = contrast(before, after);
        const auto outliers = std::max(before.outliers, after.outliers);
        best = {.t = spans[i].begin,
                .first_edge = spans[i].first_edge,
                .gain = static_cast<double>(outliers) * kOutlierSigmas * kOutlierSigmas};
      }
    }
  }
  return best;
}

}  // namespace

std::optional<Changepoint> find_changepoint(const PassModel& model, std::span<const PassEdge> edges,
                                            const SpinState& state) {
  const std::vector<SpanInformation> spans = information_by_span(model, edges, state, kSpans);
  if (spans.size() < 2) {
    return std::nullopt;
  }
  if (const auto change = change_to_outliers(spans)) {
    return change;
  }
  PassInformation after;
  for (const SpanInformation& span : spans) {
    after += span.of;
  }
  const double together = gain_of(after);
  const double excess_noise = after.excess_noise(kMotionUnknowns);
  PassInformation before;
  std::optional<Changepoint> best;
  for (std::size_t i = 1; i < spans.size(); ++i) {
    before += spans[i - 1].of;
    after = {};
    for (std::size_t j = i; j < spans.size(); ++j) {
      after += spans[j].of;
    }
    const double gain = (gain_of(before) + gain_of(after) - together) / excess_noise;
    if (gain > kSignificant && (!best || gain > best->gain)) {
      best = Changepoint{.t = spans[i].begin, .first_edge = spans[i].first_edge, .gain = gain};
    }
  }
  return best;
}

}  // namespace spindrift
