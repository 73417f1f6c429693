#include "pipelines/statistics/robust_mean.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <span>
#include <vector>

#include "tests/support/matchers.h"

namespace spindrift::robust_mean_test {

constexpr ClipRule kThreeSigma{.sigma = 3.0, .stated = 1.0};

RobustMean robust_mean(std::span<const double> values, const ClipRule& rule) {
  SlidingRobustMean mean{values.size()};
  for (const double value : values) {
    mean.add(value);
  }
  return mean.mean(rule);
}

TEST(RobustMean, OfOneValueIsThatValue) {
  const RobustMean mean = robust_mean(std::vector{7.25}, kThreeSigma);
  EXPECT_EQ(mean.mean, 7.25);
  EXPECT_EQ(mean.kept, 1U);
  EXPECT_EQ(mean.sigma, kThreeSigma.stated);
}

TEST(RobustMean, WithoutOutliersIsTheArithmeticMeanAndSampleDeviation) {
  // 1 to 11: mean 6, squared deviations 2 (25 + 16 + 9 + 4 + 1) = 110 over ten.
  std::vector<double> values(11);
  std::iota(values.begin(), values.end(), 1.0);
  const RobustMean mean = robust_mean(values, kThreeSigma);
  EXPECT_DOUBLE_EQ(mean.mean, 6.0);
  EXPECT_DOUBLE_EQ(mean.sigma, std::sqrt(11.0));
  EXPECT_DOUBLE_EQ(mean.limit, 3.0 * std::sqrt(11.0));
  EXPECT_EQ(mean.kept, 11U);
}

TEST(RobustMean, OutliersMoveNeitherMeanNorSigma) {
  std::vector<double> values(11);
  std::iota(values.begin(), values.end(), 1.0);
  for (const double outlier : {1e3, -1e9, 5e12, 80.0}) {
    values.push_back(outlier);
  }
  const RobustMean mean = robust_mean(values, kThreeSigma);
  EXPECT_DOUBLE_EQ(mean.mean, 6.0);
  EXPECT_DOUBLE_EQ(mean.sigma, std::sqrt(11.0));
  EXPECT_EQ(mean.kept, 11U);
  EXPECT_TRUE(mean.keeps(11.0));
  EXPECT_FALSE(mean.keeps(80.0));
}

TEST(RobustMean, WithstandsFourOutliersAmongTen) {
  std::mt19937_64 rng{11};
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 500; ++trial) {
    std::vector<double> values(10);
    std::ranges::generate(values, [&] { return 100.0 + normal(rng); });
    std::fill(values.begin(), values.begin() + 4, 1e6);
    // The mean of six normal values is within 5 / sqrt(6) of the centre, except once in 2 million
    // times.
    ASSERT_NEAR(robust_mean(values, kThreeSigma).mean, 100.0, 5.0 / std::sqrt(6.0));
  }
}

TEST(RobustMean, EqualValuesAreAllKept) {
  const RobustMean mean = robust_mean(std::vector<double>(50, 0.1), {.sigma = 3.0, .stated = 1e-6});
  EXPECT_DOUBLE_EQ(mean.mean, 0.1);
  EXPECT_EQ(mean.kept, 50U);
}

TEST(RobustMean, ACoarseGridRejectsNoNeighbour) {
  // Telemetry in steps of 1 ms with a noise of 1 ms has mostly equal values, so that the median
  // absolute deviation and at first the limit are zero.
  std::vector<double> values(40, 1.0);
  values.push_back(1.001);
  values.push_back(0.999);
  const RobustMean mean = robust_mean(values, {.sigma = 3.0, .stated = 1.1e-3});
  EXPECT_EQ(mean.kept, values.size());
  EXPECT_DOUBLE_EQ(mean.mean, 1.0);
}

TEST(RobustMean, ValuesBeyondTheGridAreStillOutliers) {
  std::vector<double> values(40, 1.0);
  values.push_back(1.002);
  const RobustMean mean = robust_mean(values, {.sigma = 3.0, .stated = 1.1e-3});
  EXPECT_EQ(mean.kept, 40U);
  EXPECT_FALSE(mean.keeps(1.002));
}

TEST(RobustMean, FewerThanTenValuesAreGivenTheStatedNoise) {
  // The nine values scatter by 0.001 and the stated noise is 1: 2.9 is within three stated sigmas,
  // which apply to nine values but not to ten.
  std::vector<double> values{-0.001, 0.001, 0.0, 0.0, -0.001, 0.001, 0.0, 0.0, 2.9};
  EXPECT_EQ(robust_mean(values, kThreeSigma).kept, 9U);
  values.push_back(0.0);
  EXPECT_EQ(robust_mean(values, kThreeSigma).kept, 9U);
  EXPECT_FALSE(robust_mean(values, kThreeSigma).keeps(2.9));
}

TEST(RobustMean, ALimitBelowOneSigmaLeavesSomethingToKeep) {
  std::mt19937_64 rng{12};
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<double> values(static_cast<std::size_t>(2 + trial % 30));
    std::ranges::generate(values, [&] { return normal(rng); });
    const RobustMean mean = robust_mean(values, {.sigma = 0.05, .stated = 1e-9});
    const auto [least, greatest] = std::minmax_element(values.begin(), values.end());
    ASSERT_GE(mean.mean, *least);
    ASSERT_LE(mean.mean, *greatest);
    ASSERT_TRUE(std::isfinite(mean.sigma));
    ASSERT_GT(mean.limit, 0.0);
  }
}

TEST(RobustMean, DoesNotDependOnTheOrderOfItsValues) {
  // Halves have exact sums in any order.
  std::vector<double> values{0.5, 1.5, -0.5, 2.0, 1.0, 0.0, 1.0, 3.0, 90.0, -1.0, 0.5, 1.5};
  const RobustMean first = robust_mean(values, kThreeSigma);
  std::mt19937_64 rng{13};
  for (int trial = 0; trial < 50; ++trial) {
    std::ranges::shuffle(values, rng);
    const RobustMean again = robust_mean(values, kThreeSigma);
    ASSERT_DOUBLE_EQ(again.mean, first.mean);
    ASSERT_DOUBLE_EQ(again.limit, first.limit);
    ASSERT_EQ(again.kept, first.kept);
  }
}

TEST(RobustMean, ClipsTheShareOfAGaussianThatLiesBeyondThreeSigma) {
  std::mt19937_64 rng{14};
  std::normal_distribution<double> normal;
  std::vector<double> values(100000);
  std::ranges::generate(values, [&] { return normal(rng); });
  std::ranges::sort(values);  // The run time depends on the order.
  const RobustMean mean = robust_mean(values, kThreeSigma);
  // Clipping a Gaussian at 3 s, with s the deviation of what is kept, has the fixed point s^2 = 1 -
  // 2 k phi(k) / (2 Phi(k) - 1) with k = 3 s: s = 0.984846, and 0.003131 are clipped.
  constexpr double kSigmaError = 4.0 * 0.00224;    // Four standard errors, 1 / sqrt(2 * 1e5).
  constexpr double kClippedError = 4.0 * 0.00018;  // Four standard errors, sqrt(0.003131 / 1e5).
  EXPECT_NEAR(mean.sigma, 0.984846, kSigmaError);
  EXPECT_NEAR(1.0 - static_cast<double>(mean.kept) / 1e5, 0.003131, kClippedError);
  EXPECT_NEAR(mean.mean, 0.0, 4.0 / std::sqrt(1e5));
}

TEST(RobustMean, ForgetsAllButTheLastValues) {
  std::mt19937_64 rng{15};
  std::normal_distribution<double> normal;
  SlidingRobustMean sliding{20};
  std::vector<double> all;
  for (int i = 0; i < 500; ++i) {
    // Outliers and equal values, both on a grid.
    all.push_back(std::round(10.0 * normal(rng)) / 10.0 + (i % 9 == 0 ? 30.0 : 0.0));
    sliding.add(all.back());
    const std::size_t length = std::min<std::size_t>(all.size(), 20);
    ASSERT_EQ(sliding.size(), length);
    const RobustMean expected = robust_mean(std::span<const double>{all}.last(length), kThreeSigma);
    const RobustMean mean = sliding.mean(kThreeSigma);
    ASSERT_EQ(mean.mean, expected.mean);
    ASSERT_EQ(mean.limit, expected.limit);
    ASSERT_EQ(mean.kept, expected.kept);
  }
}

}  // namespace spindrift::robust_mean_test
