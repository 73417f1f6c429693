#include "pipelines/spin/association/robust_line.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>

#include "pipelines/statistics/median.h"
#include "pipelines/statistics/significance.h"

namespace spindrift {
namespace {

struct Line {
  double turn;
  double phase;
  double drift;

  double off(const PhasePoint& point) const {
    return std::abs(point.phase - phase - drift * (point.turn - turn));
  }
};

/// Returns the deviation that just more than half of the points stay within.
double median_off(std::span<const PhasePoint> points, const Line& line,
                  std::vector<double>& scratch) {
  scratch.resize(points.size());
  std::transform(points.begin(), points.end(), scratch.begin(),
                 [&](const PhasePoint& point) { return line.off(point); });
  return upper_median(scratch);
}

Line least_squares(const std::vector<PhasePoint>& points, double most_drift) {
  const auto count = static_cast<double>(points.size());
  Line line{.turn = 0.0, .phase = 0.0, .drift = 0.0};
  for (const PhasePoint& point : points) {
    line.turn += point.turn / count;
    line.phase += point.phase / count;
  }
  double across = 0.0;
  double along = 0.0;
  for (const PhasePoint& point : points) {
    across += (point.turn - line.turn) * (point.phase - line.phase);
    along += (point.turn - line.turn) * (point.turn - line.turn);
  }
  if (along > 0.0) {
    line.drift = std::clamp(across / along, -most_drift, most_drift);
  }
  return line;
}

std::vector<PhasePoint> near_to(const Line& line, double limit,
                                std::span<const PhasePoint> points) {
  std::vector<PhasePoint> near;
  std::copy_if(points.begin(), points.end(), std::back_inserter(near),
               [&](const PhasePoint& point) { return line.off(point) <= limit; });
  return near;
}

}  // namespace

std::optional<RobustLine> fit_robust_line(std::span<const PhasePoint> points, double noise,
                                          double most_drift) {
  if (points.empty()) {
    return std::nullopt;
  }
  std::vector<double> scratch;
  Line best{.turn = points.front().turn, .phase = points.front().phase, .drift = 0.0};
  double least_off = median_off(points, best, scratch);
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = i + 1; j < points.size(); ++j) {
      const double turns = points[j].turn - points[i].turn;
      const double drift = turns != 0.0 ? (points[j].phase - points[i].phase) / turns : 0.0;
      if (std::abs(drift) > most_drift) {
        continue;
      }
      const Line line{.turn = points[i].turn, .phase = points[i].phase, .drift = drift};
      const double off = median_off(points, line, scratch);
      if (off < least_off) {
        least_off = off;
        best = line;
      }
    }
  }
  // With few points the best line passes through half of them by construction.
  const double few = 1.0 + 5.0 / static_cast<double>(points.size());
  const double scatter = std::max(noise, kSigmaPerMad * few * least_off);
  std::vector<PhasePoint> agreeing = near_to(best, 3.0 * scatter, points);
  best = least_squares(agreeing, most_drift);
  return RobustLine{.turn = best.turn,
                    .phase = best.phase,
                    .drift = best.drift,
                    .scatter = scatter,
                    .agreeing = std::move(agreeing)};
}

double circular_median(std::span<const double> phases) {
  assert(!phases.empty());
  const auto spread = [&](double centre) {
    double sum = 0.0;
    for (const double phase : phases) {
      sum += std::abs(std::remainder(phase - centre, 1.0));
    }
    return sum;
  };
  return *std::min_element(phases.begin(), phases.end(),
                           [&](double a, double b) { return spread(a) < spread(b); });
}

}  // namespace spindrift
