#include "pipelines/spin/mean/fixes_by_case.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>
#include <random>

#include "pipelines/frames/celestial.h"
#include "tests/support/axis_scene.h"

namespace spindrift::fixes_by_case_test {

using Scene = testing::AxisScene;

RevolutionMeasurements seen(const Scene& scene, std::mt19937_64& rng) {
  return measure(scene.config, testing::noisy(scene, scene.seen(), rng));
}

RevolutionMeasurements without_sun2(const Scene& scene, std::mt19937_64& rng) {
  RevolutionMeasurements measured = seen(scene, rng);
  reject(measured, SpinQuantity::SunAngle, Rejection::SunAngle);
  return measured;
}

void add(FixesByCase& fixes, int geometry_case, const Scene& scene,
         const RevolutionMeasurements& measured) {
  fixes.add(geometry_case, fixes.next_stretch(geometry_case), scene.config, measured,
            scene.sun_earth(), scene.axis_icrf);
}

void leave_out(FixesByCase& fixes, int geometry_case, int count) {
  for (int i = 0; i < count; ++i) {
    fixes.leave_out(geometry_case, fixes.next_stretch(geometry_case));
  }
}

FixesByCase fixes_about(const Scene& scene, std::size_t stretch_fixes = 1000) {
  FixesByCase fixes{stretch_fixes};
  fixes.begin_at(scene.axis_icrf);
  return fixes;
}

/// Of all events of one probability a half-space shifts the mean the most: by the density at its
/// edge over the probability.
TEST(FixesByCase, ShiftIsThatOfAHalfSpaceAtLeastAndHalfAsMuchMoreAtMost) {
  for (double edge = -5.0; edge <= 5.0; edge += 0.25) {
    SCOPED_TRACE(edge);
    const double share = 0.5 * std::erfc(edge / std::numbers::sqrt2);
    const double density = std::exp(-0.5 * edge * edge) / std::sqrt(2.0 * std::numbers::pi);
    EXPECT_GE(largest_selection_shift_sigmas(share), density / share);
    EXPECT_LE(largest_selection_shift_sigmas(share), 1.5 * density / share);
  }
  EXPECT_EQ(largest_selection_shift_sigmas(1.0), 0.0);
}

TEST(FixesByCase, WithNothingLeftOutTheMeanIsThatOfAllFixes) {
  const Scene scene;
  std::mt19937_64 rng{31};
  FixesByCase fixes = fixes_about(scene);
  AngleEquations all{scene.axis_icrf};
  for (int i = 0; i < 20; ++i) {
    const RevolutionMeasurements measured =
        i % 2 == 0 ? seen(scene, rng) : without_sun2(scene, rng);
    add(fixes, i % 2 == 0 ? 1 : 4, scene, measured);
    all.add(scene.config, measured, scene.sun_earth(), scene.axis_icrf);
  }
  const MeanOfCases mean = fixes.mean();
  EXPECT_EQ(mean.count, 20U);
  EXPECT_NEAR(mean.settled_share, 1.0, 1e-6);
  EXPECT_LT(angle_between_rad(mean.equations.axis_icrf(), all.axis_icrf()), 1e-12);
  EXPECT_TRUE(mean.covariance_rad2.isApprox(all.covariance_rad2(), 1e-9));
}

TEST(FixesByCase, ACaseMostlyLeftOutIsNotInTheMeanOfOthers) {
  const Scene scene;
  std::mt19937_64 rng{32};
  FixesByCase fixes = fixes_about(scene);
  AngleEquations others{scene.axis_icrf};
  for (int i = 0; i < 10; ++i) {
    add(fixes, 4, scene, without_sun2(scene, rng));
    const RevolutionMeasurements measured = seen(scene, rng);
    add(fixes, 1, scene, measured);
    others.add(scene.config, measured, scene.sun_earth(), scene.axis_icrf);
  }
  leave_out(fixes, 4, 90);
  const MeanOfCases mean = fixes.mean();
  EXPECT_EQ(mean.count, 10U);
  EXPECT_NEAR(mean.settled_share, 1.0, 1e-6);
  EXPECT_TRUE(mean.covariance_rad2.isApprox(others.covariance_rad2(), 1e-9));
  EXPECT_LT(angle_between_rad(mean.equations.axis_icrf(), others.axis_icrf()), 1e-12);
}

/// A selection on its own is the mean, and its uncertainty is the possible shift of all its fixes.
TEST(FixesByCase, ASelectionByItselfIsAsUncertainAsItsShift) {
  const Scene scene;
  std::mt19937_64 rng{33};
  FixesByCase fixes = fixes_about(scene);
  for (int i = 0; i < 10; ++i) {
    add(fixes, 4, scene, without_sun2(scene, rng));
  }
  leave_out(fixes, 4, 90);
  const MeanOfCases mean = fixes.mean();
  EXPECT_EQ(mean.count, 10U);
  EXPECT_NEAR(mean.settled_share, 0.1, 1e-4);
  // The shift is sqrt(2 ln 10) sigma of ten fixes.
  const Eigen::Matrix2d expected =
      mean.equations.covariance_rad2() * (1.0 + 10.0 * 2.0 * std::log(10.0));
  EXPECT_TRUE(mean.covariance_rad2.isApprox(expected, 1e-4));
}

/// A selection with little weight hardly moves the mean, however many fixes it has.
TEST(FixesByCase, ASelectionCountsByItsWeight) {
  const Scene sharp;
  Scene blunt = sharp;
  blunt.config.noise = {.sun_s = 30.0 * sharp.config.noise.sun_s,
                        .infrared_s = 30.0 * sharp.config.noise.infrared_s};
  std::mt19937_64 rng{34};
  FixesByCase fixes = fixes_about(sharp);
  for (int i = 0; i < 100; ++i) {
    add(fixes, 1, sharp, seen(sharp, rng));
    add(fixes, 2, blunt, seen(blunt, rng));
  }
  leave_out(fixes, 1, 1);
  leave_out(fixes, 2, 900);
  const MeanOfCases mean = fixes.mean();
  EXPECT_GT(mean.settled_share, 0.98);
  EXPECT_LT(mean.covariance_rad2.trace(), 1.1 * mean.equations.covariance_rad2().trace());
}

/// After the geometry has changed, noise leaves no fix out. The earlier settled fixes form the
/// selection, not these.
TEST(FixesByCase, AStretchIsNoSelectionBecauseAnEarlierOneIs) {
  const Scene scene;
  std::mt19937_64 rng{35};
  constexpr std::size_t kStretch = 20;
  FixesByCase fixes = fixes_about(scene, kStretch);
  add(fixes, 4, scene, without_sun2(scene, rng));
  leave_out(fixes, 4, kStretch - 1);
  AngleEquations later{scene.axis_icrf};
  for (std::size_t i = 0; i < 3 * kStretch; ++i) {
    const RevolutionMeasurements measured = without_sun2(scene, rng);
    add(fixes, 4, scene, measured);
    later.add(scene.config, measured, scene.sun_earth(), scene.axis_icrf);
  }
  const MeanOfCases mean = fixes.mean();
  EXPECT_EQ(mean.count, 3 * kStretch);
  EXPECT_NEAR(mean.settled_share, 1.0, 1e-6);
  EXPECT_TRUE(mean.covariance_rad2.isApprox(later.covariance_rad2(), 1e-9));
  EXPECT_LT(angle_between_rad(mean.equations.axis_icrf(), later.axis_icrf()), 1e-12);
}

/// While a stretch has few fixes, all of them may have been settled by chance.
TEST(FixesByCase, AStretchThatBeginsCountsWithTheOneBefore) {
  const Scene scene;
  std::mt19937_64 rng{36};
  constexpr std::size_t kStretch = 20;
  FixesByCase fixes = fixes_about(scene, kStretch);
  for (std::size_t i = 0; i < kStretch / 2; ++i) {
    add(fixes, 4, scene, without_sun2(scene, rng));
  }
  leave_out(fixes, 4, kStretch / 2);
  add(fixes, 4, scene, without_sun2(scene, rng));
  const MeanOfCases mean = fixes.mean();
  EXPECT_EQ(mean.count, kStretch / 2 + 1);
  EXPECT_NEAR(mean.settled_share, 11.0 / 21.0, 1e-4);
}

TEST(FixesByCase, WhatIsTakenBackIsNotLeftOut) {
  const Scene scene;
  std::mt19937_64 rng{37};
  FixesByCase fixes = fixes_about(scene);
  add(fixes, 4, scene, without_sun2(scene, rng));
  leave_out(fixes, 4, 2);
  fixes.take_back(4, 0);
  EXPECT_NEAR(fixes.mean().settled_share, 0.5, 1e-4);
}

}  // namespace spindrift::fixes_by_case_test
