#include "pipelines/spin/association/period_search.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "pipelines/spin/types/spin_rate.h"
#include "pipelines/time/time_span.h"
#include "tests/support/matchers.h"

namespace spindrift::period_search_test {

const TaiTime kStart = tai_from_ns(1'795'143'637'000'000'000);
constexpr double kNoise_s = 1e-4;
constexpr std::size_t kFewest = 5;

std::vector<TaiTime> instants(std::vector<double> times_s) {
  std::ranges::sort(times_s);
  std::vector<TaiTime> edges;
  for (const double t_s : times_s) {
    edges.push_back(later_by_s(kStart, t_s));
  }
  return edges;
}

std::optional<PulseTrain> train_of(const std::vector<double>& times_s) {
  return find_pulse_train(instants(times_s), kNoise_s, kFewest);
}

/// Returns the time after n turns at `rate_hz` that changes by `drift_per_s2`: the root of rate t +
/// drift t^2 / 2 = n that grows from 0.
double time_of_turn(int n, double rate_hz, double drift_per_s2) {
  const double root = std::sqrt(rate_hz * rate_hz + 2.0 * drift_per_s2 * n);
  return 2.0 * n / (rate_hz + root);
}

std::vector<double> even_edges(int count, double period_s) {
  std::vector<double> times_s;
  for (int n = 0; n < count; ++n) {
    times_s.push_back(n * period_s);
  }
  return times_s;
}

TEST(PeriodSearch, EvenEdgesAreACombOfTheirSpacing) {
  for (const double period_s : {0.26, 0.6, 1.0, 4.75, 14.9}) {
    SCOPED_TRACE(period_s);
    const auto comb = train_of(even_edges(20, period_s)).value();
    // Times are rounded to nanoseconds.
    EXPECT_NEAR(comb.period_s, period_s, 1e-9);
    EXPECT_NEAR(elapsed_s(kStart, comb.t), 0.0, 2e-9);
    EXPECT_EQ(comb.drift_per_s2, 0.0);
    EXPECT_EQ(comb.edges, 20U);
    EXPECT_EQ(comb.turns, 19.0);
    EXPECT_GE(comb.scatter_s, kNoise_s);
  }
}

TEST(PeriodSearch, SpacingsOutsideWhatIsSearchedAndTooFewEdgesAreNone) {
  EXPECT_FALSE(train_of(even_edges(20, 0.9 * 60.0 / kFastestSearched_rpm)));
  EXPECT_FALSE(train_of(even_edges(20, 1.1 * 60.0 / kSlowestSearched_rpm)));
  EXPECT_FALSE(train_of(even_edges(4, 1.0)));
  EXPECT_TRUE(train_of(even_edges(5, 1.0)));
  EXPECT_FALSE(train_of({}));
}

/// The slope of a line through n equidistant points has a standard deviation of sigma sqrt(12 /
/// (n^3 - n)).
TEST(PeriodSearch, NoiseMovesThePeriodAsTheSlopeOfALine) {
  std::mt19937_64 rng{41};
  std::normal_distribution<double> noise_s{0.0, kNoise_s};
  constexpr int kEdges = 32;
  constexpr int kTrials = 300;
  double squares = 0.0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const double period_s = std::uniform_real_distribution{0.5, 10.0}(rng);
    std::vector<double> times_s = even_edges(kEdges, period_s);
    for (double& t_s : times_s) {
      t_s += noise_s(rng);
    }
    const auto comb = train_of(times_s);
    ASSERT_TRUE(comb) << trial;
    squares += std::pow(comb->period_s - period_s, 2);
  }
  const double sigma_s = kNoise_s * std::sqrt(12.0 / (kEdges * (kEdges * kEdges - 1.0)));
  // A robust line is less efficient than least squares: medians need up to pi / 2 times the points.
  const double ratio = std::sqrt(squares / kTrials) / sigma_s;
  EXPECT_GT(ratio, 0.85);
  EXPECT_LT(ratio, 1.6);
}

TEST(PeriodSearch, ADriftIsThatOfTheRate) {
  for (const double drift_per_s2 : {-1e-5, 8e-6}) {
    constexpr double kRate_hz = 0.8;
    std::vector<double> times_s;
    for (int n = 0; n < 30; ++n) {
      times_s.push_back(time_of_turn(n, kRate_hz, drift_per_s2));
    }
    const auto comb = find_pulse_train(instants(times_s), 1e-6, kFewest).value();
    // A parabola in turns neglects the third order, about (drift / rate^2)^2 n of the drift.
    EXPECT_NEAR(comb.drift_per_s2, drift_per_s2, 0.01 * std::abs(drift_per_s2));
    EXPECT_NEAR(comb.period_s, 1.0 / kRate_hz, 1e-6);
  }
}

/// A quarter of the edges is lost and every eighth is a stray: the period must not become a
/// multiple or a fraction.
TEST(PeriodSearch, LostAndStrayEdgesChangeNeitherThePeriodNorItsCount) {
  std::mt19937_64 rng{42};
  std::uniform_real_distribution<double> share;
  int found = 0;
  constexpr int kTrials = 300;
  for (int trial = 0; trial < kTrials; ++trial) {
    const double period_s = std::uniform_real_distribution{0.5, 10.0}(rng);
    std::vector<double> times_s;
    for (int n = 0; n < 32; ++n) {
      if (share(rng) > 0.25) {
        times_s.push_back(n * period_s);
      }
      if (share(rng) < 0.125) {
        times_s.push_back((n + share(rng)) * period_s);
      }
    }
    if (const auto comb = train_of(times_s)) {
      EXPECT_NEAR(comb->period_s, period_s, 1e-3 * period_s) << trial;
      ++found;
    }
  }
  EXPECT_GT(found, kTrials * 9 / 10);
}

/// Two receivers each lose a tenth of the edges and have independent clock noise.
TEST(PeriodSearch, EdgesThatComeSeveralTimesHaveThePeriodOfTheFirst) {
  std::mt19937_64 rng{44};
  std::normal_distribution<double> normal;
  std::bernoulli_distribution lost{0.1};
  for (const double period_s : {0.6, 1.0, 10.0}) {
    for (const double behind_s : {1e-9, 1e-4, 0.005, 0.02}) {
      for (const int receivers : {2, 3}) {
        SCOPED_TRACE(::testing::Message() << period_s << " s, " << behind_s << " s behind");
        std::vector<double> times_s;
        for (int n = 0; n < 20; ++n) {
          const double t_s = n * period_s + kNoise_s * normal(rng);
          for (int receiver = 0; receiver < receivers; ++receiver) {
            if (!lost(rng)) {
              times_s.push_back(t_s +
                                receiver * (behind_s / (receivers - 1) + kNoise_s * normal(rng)));
            }
          }
        }
        const auto comb = train_of(times_s).value();
        // The sigma of a slope through twenty points, with the noise of two, is 1/13 of the noise.
        EXPECT_NEAR(comb.period_s, period_s, kNoise_s);
      }
    }
  }
}

TEST(PeriodSearch, EdgesAtRandomHaveSeldomAPeriod) {
  std::mt19937_64 rng{43};
  std::uniform_real_distribution<double> t_s{0.0, 60.0};
  int found = 0;
  for (int trial = 0; trial < 300; ++trial) {
    std::vector<double> times_s(30);
    std::ranges::generate(times_s, [&] { return t_s(rng); });
    found += train_of(times_s) ? 1 : 0;
  }
  EXPECT_LE(found, 3);
}

}  // namespace spindrift::period_search_test
