#include "pipelines/spin/association/robust_line.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "tests/support/matchers.h"

namespace spindrift::robust_line_test {

constexpr double kNoise = 1e-4;
constexpr double kMostDrift = 0.01;

std::vector<PhasePoint> on_a_line(int points) {
  std::vector<PhasePoint> line;
  for (int turn = 0; turn < points; ++turn) {
    line.push_back({.turn = 1.0 * turn, .phase = 0.2 + 0.003 * turn});
  }
  return line;
}

TEST(RobustLine, IsThatOfTheMajorityWhateverTheMinoritySays) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    std::mt19937_64 random{seed};
    std::vector<PhasePoint> points = on_a_line(11);
    std::ranges::shuffle(points, random);
    for (std::size_t i = 0; i < 5; ++i) {
      points[i].phase = std::uniform_real_distribution<double>{0.3, 0.9}(random);
    }
    const RobustLine line = fit_robust_line(points, kNoise, kMostDrift).value();
    EXPECT_NEAR(line.at(0.0), 0.2, 1e-12);
    EXPECT_NEAR(line.drift, 0.003, 1e-13);
    EXPECT_EQ(line.agreeing.size(), 6U);
    EXPECT_EQ(line.scatter, kNoise);
  }
}

TEST(RobustLine, OfGoodPointsIsLeastSquaresWithTheirScatter) {
  constexpr double kScatter = 0.002;
  std::mt19937_64 random{5};
  std::normal_distribution<double> noise{0.0, kScatter};
  std::vector<PhasePoint> points = on_a_line(40);
  double phase = 0.0;
  for (PhasePoint& point : points) {
    point.phase += noise(random);
    phase += point.phase / 40.0;
  }
  const RobustLine line = fit_robust_line(points, kNoise, kMostDrift).value();
  EXPECT_EQ(line.agreeing.size(), points.size());
  EXPECT_EQ(line.turn, 19.5);
  EXPECT_NEAR(line.phase, phase, 1e-12);
  EXPECT_NEAR(line.scatter, kScatter, 0.5 * kScatter);
}

TEST(RobustLine, IsNoSteeperThanAllowedAndThereForOnePoint) {
  EXPECT_FALSE(fit_robust_line({}, kNoise, kMostDrift));
  const std::array<PhasePoint, 1> one{{{.turn = 3.0, .phase = 0.4}}};
  const RobustLine level = fit_robust_line(one, kNoise, kMostDrift).value();
  EXPECT_EQ(level.at(10.0), 0.4);
  std::vector<PhasePoint> steep;
  for (int turn = 0; turn < 8; ++turn) {
    steep.push_back({.turn = 1.0 * turn, .phase = 0.05 * turn});
  }
  EXPECT_LE(std::abs(fit_robust_line(steep, kNoise, kMostDrift)->drift), kMostDrift);
}

TEST(CircularMedian, DoesNotMindWhereTheCircleBegins) {
  const std::array<double, 5> phases{0.97, 0.99, 0.01, 0.02, 0.4};
  for (const double turned : {0.0, 0.3, 0.6}) {
    std::array<double, 5> moved{};
    std::transform(phases.begin(), phases.end(), moved.begin(),
                   [&](double phase) { return phase + turned - std::floor(phase + turned); });
    EXPECT_NEAR(std::remainder(circular_median(moved) - turned - 0.01, 1.0), 0.0, 1e-12);
  }
}

}  // namespace spindrift::robust_line_test
