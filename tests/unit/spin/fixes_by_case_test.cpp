#include "pipelines/spin/fixes_by_case.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>
#include <random>

#include "pipelines/frames/celestial.h"
#include "tests/support/axis_scene.h"

namespace spindrift {
namespace {

using Scene = testing::AxisScene;

RevolutionMeasurements seen(const Scene& scene, std::mt19937_64& rng) {
  return measure(scene.config, testing::noisy(scene, scene.seen(), rng));
}

RevolutionMeasurements without_sun2(const Scene& scene, std::mt19937_64& rng) {
  RevolutionMeasurements measured = seen(scene, rng);
  reject(measured, SpinQuantity::SunAngle, Rejection::SunAngle);
  return measured;
}

/// Of all events of one probability, a half-space shifts the mean the most: by the density at its
/// edge over the probability.
TEST(FixesByCase, ShiftIsThatOfAHalfSpaceAtLeastAndHalfAsMuchMoreAtMost) {
  for (double edge = -5.0; edge <= 5.0; edge += 0.25) {
    SCOPED_TRACE(edge);
    const double share = 0.5 * std::erfc(edge / std::numbers::sqrt2);
    const double density = std::exp(-0.5 * edge * edge) / std::sqrt(2.0 * std::numbers::pi);
    EXPECT_GE(most_shift_sigmas(share), density / share);
    EXPECT_LE(most_shift_sigmas(share), 1.5 * density / share);
  }
  EXPECT_EQ(most_shift_sigmas(1.0), 0.0);
}

TEST(FixesByCase, WithNothingLeftOutTheMeanIsThatOfAllFixes) {
  const Scene scene;
  std::mt19937_64 rng{31};
  FixesByCase fixes{scene.axis_icrf};
  AngleEquations all{scene.axis_icrf};
  for (int i = 0; i < 20; ++i) {
    const RevolutionMeasurements measured =
        i % 2 == 0 ? seen(scene, rng) : without_sun2(scene, rng);
    fixes.add(i % 2 == 0 ? 1 : 4, scene.config, measured, scene.sightlines(), scene.axis_icrf);
    all.add(scene.config, measured, scene.sightlines(), scene.axis_icrf);
  }
  const MeanOfCases mean = fixes.mean({});
  EXPECT_EQ(mean.count, 20U);
  EXPECT_NEAR(mean.settled_share, 1.0, 1e-6);
  EXPECT_LT(angle_between_rad(mean.equations.axis_icrf(), all.axis_icrf()), 1e-12);
  EXPECT_TRUE(mean.covariance_rad2.isApprox(all.covariance_rad2(), 1e-9));
}

TEST(FixesByCase, ACaseMostlyLeftOutIsNotInTheMeanOfOthers) {
  const Scene scene;
  std::mt19937_64 rng{32};
  FixesByCase fixes{scene.axis_icrf};
  AngleEquations others{scene.axis_icrf};
  for (int i = 0; i < 10; ++i) {
    fixes.add(4, scene.config, without_sun2(scene, rng), scene.sightlines(), scene.axis_icrf);
    const RevolutionMeasurements measured = seen(scene, rng);
    fixes.add(1, scene.config, measured, scene.sightlines(), scene.axis_icrf);
    others.add(scene.config, measured, scene.sightlines(), scene.axis_icrf);
  }
  const MeanOfCases mean = fixes.mean({{4, 90.0}});
  EXPECT_EQ(mean.count, 10U);
  EXPECT_NEAR(mean.settled_share, 1.0, 1e-6);
  EXPECT_TRUE(mean.covariance_rad2.isApprox(others.covariance_rad2(), 1e-9));
  EXPECT_LT(angle_between_rad(mean.equations.axis_icrf(), others.axis_icrf()), 1e-12);
}

/// With nothing else, it is the mean; as uncertain as the shift of all its fixes makes it.
TEST(FixesByCase, ASelectionByItselfIsAsUncertainAsItsShift) {
  const Scene scene;
  std::mt19937_64 rng{33};
  FixesByCase fixes{scene.axis_icrf};
  for (int i = 0; i < 10; ++i) {
    fixes.add(4, scene.config, without_sun2(scene, rng), scene.sightlines(), scene.axis_icrf);
  }
  const MeanOfCases mean = fixes.mean({{4, 90.0}});
  EXPECT_EQ(mean.count, 10U);
  EXPECT_NEAR(mean.settled_share, 0.1, 1e-4);
  // sqrt(2 ln 10) sigma of ten fixes.
  const Eigen::Matrix2d expected =
      mean.equations.covariance_rad2() * (1.0 + 10.0 * 2.0 * std::log(10.0));
  EXPECT_TRUE(mean.covariance_rad2.isApprox(expected, 1e-4));
}

/// A selection that weighs little moves the mean little, however many its fixes.
TEST(FixesByCase, ASelectionCountsByItsWeight) {
  const Scene sharp;
  Scene blunt = sharp;
  blunt.config.noise = {.sun_s = 30.0 * sharp.config.noise.sun_s,
                        .infrared_s = 30.0 * sharp.config.noise.infrared_s};
  std::mt19937_64 rng{34};
  FixesByCase fixes{sharp.axis_icrf};
  for (int i = 0; i < 10; ++i) {
    fixes.add(1, sharp.config, seen(sharp, rng), sharp.sightlines(), sharp.axis_icrf);
    fixes.add(2, blunt.config, seen(blunt, rng), blunt.sightlines(), blunt.axis_icrf);
  }
  // One of a hundred is left out of case 1, nine of ten of case 2.
  const MeanOfCases mean = fixes.mean({{1, 0.1}, {2, 90.0}});
  EXPECT_GT(mean.settled_share, 0.98);
  EXPECT_LT(mean.covariance_rad2.trace(), 1.1 * mean.equations.covariance_rad2().trace());
}

}  // namespace
}  // namespace spindrift
