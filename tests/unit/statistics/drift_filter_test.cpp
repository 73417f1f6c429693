#include "pipelines/statistics/drift_filter.h"

#include <Eigen/Dense>
#include <cmath>
#include <random>

#include "tests/support/matchers.h"

namespace spindrift::drift_filter_test {

constexpr DriftGate kOpen{.sigma = 1e9, .most = 1e9};
constexpr DriftState kUnknown{.x = 0.0,
                              .value = 0.0,
                              .value_sigma = 1e4,
                              .change = 0.0,
                              .change_sigma = 1e4,
                              .bend_sigma = 1e4};

TEST(DriftFilter, OfSteadyMotionIsLeastSquares) {
  constexpr DriftNoise kNoise{.measured = 0.5, .wander = 0.0};
  constexpr int kMeasured = 12;
  DriftFilter filter{kUnknown};
  Eigen::Matrix<double, kMeasured, 3> design;
  for (int i = 0; i < kMeasured; ++i) {
    const double x = 0.7 * i + 0.1 * (i % 3);
    design.row(i) << 1.0, x, 0.5 * x * x;
    EXPECT_TRUE(filter.follow(x, 3.0 - 2.0 * x + 0.5 * 0.25 * x * x, kNoise, kOpen).passed());
  }
  const double last = design(kMeasured - 1, 1);
  EXPECT_NEAR(filter.at(0.0), 3.0, 1e-6);
  EXPECT_NEAR(filter.change_at(0.0), -2.0, 1e-6);
  EXPECT_NEAR(filter.bend(), 0.25, 1e-6);
  EXPECT_EQ(filter.scale(), 1.0);
  const Eigen::Matrix3d covariance = 0.25 * (design.transpose() * design).inverse();
  for (const double x : {last, last + 4.0, last - 5.0}) {
    const Eigen::Vector3d of_value{1.0, x, 0.5 * x * x};
    EXPECT_NEAR(filter.sigma_at(x, kNoise), std::sqrt(of_value.dot(covariance * of_value)), 1e-6);
  }
}

TEST(DriftFilter, WanderWidensAsItsIntegralsDo) {
  const DriftFilter known{
      {.x = 1.0, .value = 0.0, .value_sigma = 0.0, .change = 2.0, .change_sigma = 0.0}};
  for (const double ahead : {0.5, 3.0, -3.0}) {
    const double length = std::abs(ahead);
    const DriftNoise change{.measured = 0.0, .wander = 0.3};
    EXPECT_NEAR(known.sigma_at(1.0 + ahead, change), 0.3 * std::sqrt(std::pow(length, 3) / 3.0),
                1e-12);
    EXPECT_NEAR(known.change_sigma_at(1.0 + ahead, change), 0.3 * std::sqrt(length), 1e-12);
    const DriftNoise bend{.measured = 0.0, .wander = 0.0, .bend_wander = 0.2};
    EXPECT_NEAR(known.sigma_at(1.0 + ahead, bend), 0.2 * std::sqrt(std::pow(length, 5) / 20.0),
                1e-12);
  }
}

TEST(DriftFilter, FindsTheAbscissaOfAValueOrWhereItComesNearest) {
  const DriftFilter slowing{{.x = 10.0,
                             .value = 5.0,
                             .value_sigma = 1.0,
                             .change = 1.0,
                             .change_sigma = 1.0,
                             .bend = -0.5}};
  for (const double x : {8.0, 10.0, 11.9}) {
    EXPECT_NEAR(slowing.x_of(slowing.at(x)), x, 1e-9);
  }
  // The parabola turns back at 6, two units ahead.
  EXPECT_NEAR(slowing.x_of(6.0), 12.0, 1e-9);
  EXPECT_NEAR(slowing.x_of(9.0), 12.0, 1e-9);
}

TEST(DriftFilter, TakesNothingFromBeyondItsGateNorFromThePast) {
  DriftFilter filter{
      {.x = 0.0, .value = 0.0, .value_sigma = 1.0, .change = 0.0, .change_sigma = 0.0}};
  const DriftNoise noise{.measured = 1.0, .wander = 0.0};
  const DriftTest far = filter.test(1.0, 2.1, noise, {.sigma = 3.0, .most = 2.0});
  EXPECT_DOUBLE_EQ(far.off, 2.1);
  EXPECT_DOUBLE_EQ(far.sigma, std::sqrt(2.0));
  EXPECT_EQ(far.limit, 2.0);
  EXPECT_FALSE(filter.follow(1.0, 4.3, noise, {.sigma = 3.0, .most = 10.0}).passed());
  EXPECT_FALSE(filter.follow(1.0, 2.1, noise, {.sigma = 3.0, .most = 2.0}).passed());
  EXPECT_EQ(filter.value(), 0.0);
  EXPECT_TRUE(filter.follow(1.0, 2.0, noise, {.sigma = 3.0, .most = 2.0}).passed());
  const double taken = filter.value();
  EXPECT_GT(taken, 0.5);
  EXPECT_TRUE(filter.follow(0.5, 1.0, noise, kOpen).passed());
  EXPECT_EQ(filter.value(), taken);
}

TEST(DriftFilter, ScaleIsTheScatterOverTheStatedNoise) {
  constexpr double kExcess = 4.0;
  std::mt19937_64 random{7};
  std::normal_distribution<double> scatter{0.0, kExcess};
  DriftFilter filter{kUnknown};
  double scales = 0.0;
  for (int i = 0; i < 4000; ++i) {
    filter.follow(i, scatter(random), {.measured = 1.0, .wander = 0.0}, kOpen);
    scales += i >= 1000 ? filter.scale() / 3000.0 : 0.0;
  }
  EXPECT_NEAR(scales, kExcess, 0.1 * kExcess);
}

TEST(DriftFilter, SupposedBendIsAMeasurementOfIt) {
  const DriftFilter filter{{.x = 0.0,
                            .value = 1.0,
                            .value_sigma = 0.1,
                            .change = 2.0,
                            .change_sigma = 0.1,
                            .bend = 3.0,
                            .bend_sigma = 2.0}};
  EXPECT_NEAR(filter.supposing_bend(0.0, 1.0).bend(), 3.0 / 5.0, 1e-12);
  EXPECT_NEAR(filter.supposing_bend(0.5, 0.0).bend(), 0.5, 1e-12);
  EXPECT_EQ(filter.supposing_bend(0.0, 1.0).value(), 1.0);
}

TEST(DriftFilter, ShiftMovesValueAndChangeAtThatPlace) {
  DriftFilter filter{
      {.x = 2.0, .value = 1.0, .value_sigma = 0.0, .change = 3.0, .change_sigma = 0.0}};
  const double before = filter.at(7.0);
  filter.shift(7.0, 0.25, 0.5);
  EXPECT_NEAR(filter.at(7.0), before + 0.25, 1e-12);
  EXPECT_NEAR(filter.change(), 3.5, 1e-12);
  const DriftNoise none{.measured = 0.0, .wander = 0.0};
  EXPECT_EQ(filter.sigma_at(2.0, none), 0.0);
  filter.loosen(0.3, 0.4, 0.0);
  EXPECT_NEAR(filter.sigma_at(3.0, none), 0.5, 1e-12);
}

}  // namespace spindrift::drift_filter_test
