#include "pipelines/spin/batch/changepoint.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "pipelines/time/time_span.h"

namespace spindrift {
namespace {

using Motion = Eigen::Matrix<double, kMotionUnknowns, kMotionUnknowns>;

// The chance of such a chi-square is 1e-10 for five degrees of freedom, at one of 63 places of a
// change, and 1e-13 for the one of the outlier test, at one of 2,016; but outliers come in bursts.
constexpr double kSignificant = 55.0;

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

// Parabolas through fewer edges follow their noise.
constexpr std::size_t kFewest = 8;
// Chi-square beyond the some tens that noise and nutation gain.
constexpr double kClear = 100.0;
constexpr std::size_t kPlaces = 64;

struct Turn {
  std::size_t edge;  ///< Index of the edge among all edges.
  double number;
  double t_s;
};

std::vector<Turn> turns_of(std::span<const PassEdge> edges) {
  std::array<std::size_t, kPulseChannels> counts{};
  for (const PassEdge& edge : edges) {
    ++counts.at(index_of(edge.pulse.channel));
  }
  const auto most = std::max_element(counts.begin(), counts.end()) - counts.begin();
  std::vector<Turn> turns;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (index_of(edges[i].pulse.channel) == static_cast<std::size_t>(most)) {
      turns.push_back({.edge = i,
                       .number = static_cast<double>(edges[i].revolution),
                       .t_s = seconds_between(edges.front().pulse.t, edges[i].pulse.t)});
    }
  }
  return turns;
}

/// Returns the sum of squared residuals of the best parabola, s^2.
double left_over(std::span<const Turn> turns) {
  const double middle = 0.5 * (turns.front().number + turns.back().number);
  const double half = std::max(0.5 * (turns.back().number - turns.front().number), 1.0);
  const auto powers = [&](const Turn& turn) {
    const double x = (turn.number - middle) / half;
    return Eigen::Vector3d{1.0, x, x * x};
  };
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (const Turn& turn : turns) {
    normal += powers(turn) * powers(turn).transpose();
    right += powers(turn) * (turn.t_s - turns.front().t_s);
  }
  const Eigen::Vector3d parabola = normal.ldlt().solve(right);
  double squares = 0.0;
  for (const Turn& turn : turns) {
    squares += std::pow(turn.t_s - turns.front().t_s - powers(turn).dot(parabola), 2);
  }
  return squares;
}

struct Break {
  std::size_t turn;  ///< Index of the first turn after the break.
  double squares_s2;
};

/// Returns the best break among some places from `first` to `last`.
Break best_between(std::span<const Turn> turns, std::size_t first, std::size_t last) {
  const std::size_t step = std::max<std::size_t>((last - first) / kPlaces, 1);
  Break best{.turn = first, .squares_s2 = left_over(turns)};
  for (std::size_t turn = first; turn <= last; turn += step) {
    const double squares_s2 = left_over(turns.first(turn)) + left_over(turns.subspan(turn));
    if (squares_s2 < best.squares_s2) {
      best = {.turn = turn, .squares_s2 = squares_s2};
    }
  }
  return best;
}

}  // namespace

std::optional<Changepoint> find_rate_changepoint(std::span<const PassEdge> edges) {
  const std::vector<Turn> turns = turns_of(edges);
  if (turns.size() < 2 * kFewest) {
    return std::nullopt;
  }
  std::size_t first = kFewest;
  std::size_t last = turns.size() - kFewest;
  Break best = best_between(turns, first, last);
  for (std::size_t step = (last - first) / kPlaces; step > 1; step /= kPlaces / 2) {
    first = std::max(kFewest, best.turn - std::min(best.turn, step));
    last = std::min(turns.size() - kFewest, best.turn + step);
    best = best_between(turns, first, last);
  }
  const double gain =
      static_cast<double>(turns.size()) * std::log(left_over(turns) / best.squares_s2);
  if (!(gain > kClear)) {
    return std::nullopt;
  }
  const std::size_t edge = turns[best.turn].edge;
  return Changepoint{.t = edges[edge].pulse.t, .first_edge = edge, .gain = gain};
}

std::optional<Changepoint> find_changepoint(const PassModel& model, std::span<const PassEdge> edges,
                                            const SpinState& state) {
  const std::vector<SpanInformation> spans = information_by_span(model, edges, state, 64);
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
