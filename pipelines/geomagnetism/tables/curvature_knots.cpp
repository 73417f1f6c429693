#include "pipelines/geomagnetism/tables/curvature_knots.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "pipelines/frames/angle.h"

namespace spindrift {
namespace {

using Eigen::Index;
using Eigen::Vector2d;
using Eigen::Vector3d;

// Length U of the arms of the chord, in units of the graph.
constexpr double kArm = 0.05;
constexpr double kLeastWeight = 0.02;
constexpr double kMostWeight = 50.0;
constexpr double kWeightStep = 1.1;

using Graph = std::vector<Vector2d>;

Graph graph_of(const SampledField& field_nt, Index axis, double range_nt) {
  Graph graph;
  const double step_rad = kTurn_rad / static_cast<double>(field_nt.cols() - 1);
  for (Index i = 0; i < field_nt.cols(); ++i) {
    graph.emplace_back(step_rad * static_cast<double>(i), field_nt(axis, i) / range_nt);
  }
  return graph;
}

/// Returns where the graph leaves the circle of radius U about a point; empty beyond its end.
std::optional<Vector2d> end_of_arm(const Graph& graph, std::size_t from, int direction) {
  const auto last = static_cast<std::ptrdiff_t>(graph.size()) - 1;
  const Vector2d& centre = graph[from];
  double inside = 0.0;
  for (auto i = static_cast<std::ptrdiff_t>(from) + direction; i >= 0 && i <= last;
       i += direction) {
    const Vector2d& here = graph[static_cast<std::size_t>(i)];
    const double away = (here - centre).norm();
    if (away >= kArm) {
      const Vector2d& before = graph[static_cast<std::size_t>(i - direction)];
      return before + (kArm - inside) / (away - inside) * (here - before);
    }
    inside = away;
  }
  return std::nullopt;
}

/// Returns the curvature of one graph. The ends of it have no chord and take that of the nearest
/// point that has one.
std::vector<double> curvature_of(const Graph& graph) {
  std::vector<double> curvature(graph.size(), 0.0);
  std::size_t first = graph.size();
  std::size_t last = 0;
  for (std::size_t i = 0; i < graph.size(); ++i) {
    const auto behind = end_of_arm(graph, i, -1);
    const auto ahead = end_of_arm(graph, i, 1);
    if (behind && ahead) {
      const double share = (*ahead - *behind).norm() / (2.0 * kArm);
      curvature[i] = std::sqrt(std::max(1.0 - share * share, 0.0));
      first = std::min(first, i);
      last = i;
    }
  }
  std::fill(curvature.begin(), curvature.begin() + static_cast<std::ptrdiff_t>(first),
            curvature.at(first));
  std::fill(curvature.begin() + static_cast<std::ptrdiff_t>(last), curvature.end(),
            curvature[last]);
  return curvature;
}

Vector3d interpolated(const SampledField& field_nt, double place) {
  const double at = place * static_cast<double>(field_nt.cols() - 1);
  const Index i = std::min(static_cast<Index>(at), field_nt.cols() - 2);
  const double share = at - static_cast<double>(i);
  return (1.0 - share) * field_nt.col(i) + share * field_nt.col(i + 1);
}

}  // namespace

std::vector<double> chord_curvature(const SampledField& field_nt) {
  std::vector<double> sum(static_cast<std::size_t>(field_nt.cols()), 0.0);
  for (Index axis = 0; axis < 3; ++axis) {
    const double range_nt = field_nt.row(axis).maxCoeff() - field_nt.row(axis).minCoeff();
    if (range_nt > 0.0) {
      const auto of_axis = curvature_of(graph_of(field_nt, axis, range_nt));
      std::transform(sum.begin(), sum.end(), of_axis.begin(), sum.begin(), std::plus<>{});
    }
  }
  return sum;
}

std::vector<double> knots_by_curvature(const std::vector<double>& curvature, double weight,
                                       int points) {
  const double all = std::accumulate(curvature.begin(), curvature.end(),
                                     -0.5 * (curvature.front() + curvature.back()));
  const auto steps = static_cast<double>(curvature.size() - 1);
  std::vector<double> places{0.0};
  double reached = 0.0;
  for (std::size_t i = 1; i < curvature.size(); ++i) {
    const double between = 0.5 * (curvature[i - 1] + curvature[i]) / all + weight / steps;
    while (std::ssize(places) < points - 1) {
      const double wanted =
          (1.0 + weight) * static_cast<double>(places.size()) / static_cast<double>(points - 1);
      if (wanted > reached + between) {
        break;
      }
      places.push_back((static_cast<double>(i) - 1.0 + (wanted - reached) / between) / steps);
    }
    reached += between;
  }
  places.push_back(1.0);
  return places;
}

double mean_error_nt(const SampledField& field_nt, const std::vector<double>& places) {
  double sum_nt = 0.0;
  std::size_t next = 1;
  Vector3d from_nt = field_nt.col(0);
  Vector3d to_nt = interpolated(field_nt, places[next]);
  for (Index i = 0; i < field_nt.cols(); ++i) {
    const double place = static_cast<double>(i) / static_cast<double>(field_nt.cols() - 1);
    while (place > places[next] && next + 1 < places.size()) {
      from_nt = to_nt;
      to_nt = interpolated(field_nt, places[++next]);
    }
    const double share = (place - places[next - 1]) / (places[next] - places[next - 1]);
    sum_nt += ((1.0 - share) * from_nt + share * to_nt - field_nt.col(i)).lpNorm<1>();
  }
  return sum_nt / static_cast<double>(field_nt.cols());
}

std::vector<double> studied_weights() {
  std::vector<double> weights;
  for (double weight = kLeastWeight; weight <= kMostWeight; weight *= kWeightStep) {
    weights.push_back(weight);
  }
  return weights;
}

CurvatureKnots curvature_knots(const SampledField& field_nt, int points) {
  const std::vector<double> curvature = chord_curvature(field_nt);
  CurvatureKnots best{};
  double least_nt = std::numeric_limits<double>::infinity();
  for (const double weight : studied_weights()) {
    std::vector<double> places = knots_by_curvature(curvature, weight, points);
    if (const double error_nt = mean_error_nt(field_nt, places); error_nt < least_nt) {
      least_nt = error_nt;
      best = {.places = std::move(places), .weight = weight};
    }
  }
  return best;
}

}  // namespace spindrift
