#include "pipelines/spin/sequential/starting_points.h"

#include <cmath>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "tests/support/matchers.h"

namespace spindrift::starting_points_test {

Eigen::Vector3d axis_at(double ra_deg, double dec_deg) {
  return direction_icrf({.ra_rad = ra_deg * kRadPerDeg, .dec_rad = dec_deg * kRadPerDeg});
}

StartingPoint drawn(const Eigen::Vector3d& axis_icrf, double sigma_deg, std::mt19937_64& rng) {
  std::normal_distribution<double> noise{0.0, sigma_deg * kRadPerDeg};
  const Eigen::Vector2d off_rad{noise(rng), noise(rng)};
  return {.axis_icrf = (axis_icrf + tangent_basis(axis_icrf) * off_rad).normalized(),
          .covariance_rad2 = std::pow(sigma_deg * kRadPerDeg, 2) * Eigen::Matrix2d::Identity()};
}

TEST(StartingPoints, OneSharpCandidateIsItsOwnBranch) {
  std::mt19937_64 rng{1};
  const std::vector candidates{drawn(axis_at(10.0, 89.0), 0.5, rng)};
  const auto known = StartingPoints{}.add(candidates).value();
  ASSERT_EQ(known.points.size(), 1U);
  EXPECT_LT(angle_between_rad(known.points.front().axis_icrf, candidates.front().axis_icrf), 1e-12);
  EXPECT_TRUE(well_known(known.points.front().covariance_rad2));
  EXPECT_EQ(known.fixes, 1);
}

TEST(StartingPoints, PoorCandidatesAreAveragedUntilTheyAreKnownWell) {
  // The sigma is 7 deg over both directions, so the mean is below 3 deg from the sixth on.
  std::mt19937_64 rng{2};
  const Eigen::Vector3d axis = axis_at(359.9, 80.0);
  StartingPoints points;
  for (int count = 1; count <= 10; ++count) {
    const auto known = points.add(std::vector{drawn(axis, 7.0 / std::numbers::sqrt2, rng)});
    ASSERT_EQ(known.has_value(), count >= 6) << count;
    if (known) {
      EXPECT_EQ(known->fixes, count);
      const StartingPoint& point = known->points.front();
      const double sigma_rad = std::sqrt(point.covariance_rad2.trace());
      // The tangent planes of the candidates differ slightly from that of their mean.
      EXPECT_NEAR(sigma_rad / kRadPerDeg, 7.0 / std::sqrt(count), 0.1);
      EXPECT_LT(angle_between_rad(point.axis_icrf, axis), 4.0 * sigma_rad);
    }
  }
  points.forget();
  EXPECT_FALSE(points.add(std::vector{drawn(axis, 7.0 / std::numbers::sqrt2, rng)}));
}

TEST(StartingPoints, BranchesStayApartInWhateverOrderTheirCandidatesCome) {
  std::mt19937_64 rng{3};
  const Eigen::Vector3d one = axis_at(100.0, -55.0);
  const Eigen::Vector3d other = axis_at(140.0, -20.0);
  StartingPoints points;
  int times_known = 0;
  for (int count = 0; count < 40; ++count) {
    std::vector<std::pair<Eigen::Vector3d, StartingPoint>> candidates{
        {one, drawn(one, 4.0, rng)}, {other, drawn(other, 4.0, rng)}};
    if (count % 3 == 0) {
      std::swap(candidates[0], candidates[1]);
    }
    const auto known = points.add(std::vector{candidates[0].second, candidates[1].second});
    if (!known) {
      continue;
    }
    ++times_known;
    ASSERT_EQ(known->points.size(), 2U);
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_LT(angle_between_rad(known->points[i].axis_icrf, candidates[i].first),
                5.0 * std::sqrt(known->points[i].covariance_rad2.trace()));
    }
  }
  // The sigma is 5.7 deg over both directions, so the mean is good enough from the fourth on.
  EXPECT_EQ(times_known, 37);
}

TEST(StartingPoints, OneFixNeverNamesABranchTwice) {
  // The candidates are half a degree apart, within the allowance for model errors, and yet
  // distinct.
  std::mt19937_64 rng{4};
  const std::vector both{drawn(axis_at(100.0, 0.0), 0.01, rng),
                         drawn(axis_at(100.4, 0.0), 0.01, rng)};
  StartingPoints points{3};
  for (int count = 1; count <= 6; ++count) {
    const auto known = points.add(both);
    // Three fixes are required even though each is precise.
    ASSERT_EQ(known.has_value(), count >= 3);
    if (known) {
      ASSERT_EQ(known->points.size(), 2U);
      EXPECT_GT(angle_between_rad(known->points[0].axis_icrf, known->points[1].axis_icrf),
                0.35 * kRadPerDeg);
    }
  }
}

}  // namespace spindrift::starting_points_test
