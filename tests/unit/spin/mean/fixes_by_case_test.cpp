#include "pipelines/spin/mean/fixes_by_case.h"

#include <Eigen/Dense>
#include <cmath>
#include <numbers>
#include <random>

#include "pipelines/frames/celestial.h"
#include "tests/support/axis_scene.h"
#include "tests/support/matchers.h"

namespace spindrift::testing::fixes_by_case_test {

using Scene = AxisScene;

RevolutionMeasurements seen(const Scene& scene, std::mt19937_64& rng) {
  return measure(scene.config, noisy(scene, scene.seen(), rng));
}

/// Collects fixes of a scene: cases 1 to 3 with a sun2 and case 4 without.
class FixesByCaseTest : public ::testing::Test {
 protected:
  FixesByCase begun(unsigned seed, std::size_t stretch_fixes = 1000) {
    rng_.seed(seed);
    FixesByCase fixes{stretch_fixes};
    fixes.begin_at(scene_.axis_icrf);
    return fixes;
  }
  /// Adds noisy fixes of a case, also to `others` if there are such.
  void add(FixesByCase& fixes, int geometry_case, const Scene& scene, std::size_t count = 1,
           AngleEquations* others = nullptr) {
    for (std::size_t i = 0; i < count; ++i) {
      RevolutionMeasurements measured = seen(scene, rng_);
      if (geometry_case == 4) {
        reject(measured, SpinQuantity::SunAngle, Rejection::SunAngle);
      }
      fixes.add_fix(geometry_case, fixes.next_stretch(geometry_case), scene.config, measured,
                    scene.sun_earth(), scene.axis_icrf);
      if (others != nullptr) {
        others->add(scene.config, measured, scene.sun_earth(), scene.axis_icrf);
      }
    }
  }
  static void leave_out(FixesByCase& fixes, int geometry_case, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      fixes.leave_out(geometry_case, fixes.next_stretch(geometry_case));
    }
  }
  /// Expects a mean of all fixes that these equations hold.
  static void expect_mean_of(const AngleEquations& all, std::size_t count,
                             const FixesByCase& fixes) {
    const MeanOfCases mean = fixes.mean();
    EXPECT_EQ(mean.count, count);
    EXPECT_NEAR(mean.settled_share, 1.0, 1e-6);
    EXPECT_LT(angle_between_rad(mean.equations.axis_icrf(), all.axis_icrf()), 1e-12);
    EXPECT_TRUE(mean.covariance_rad2.isApprox(all.covariance_rad2(), 1e-9));
  }

  Scene scene_;
  std::mt19937_64 rng_;
};

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

TEST_F(FixesByCaseTest, WithNothingLeftOutTheMeanIsThatOfAllFixes) {
  FixesByCase fixes = begun(31);
  AngleEquations all{scene_.axis_icrf};
  for (int i = 0; i < 20; ++i) {
    add(fixes, i % 2 == 0 ? 1 : 4, scene_, 1, &all);
  }
  expect_mean_of(all, 20, fixes);
}

TEST_F(FixesByCaseTest, ACaseMostlyLeftOutIsNotInTheMeanOfOthers) {
  FixesByCase fixes = begun(32);
  AngleEquations others{scene_.axis_icrf};
  for (int i = 0; i < 10; ++i) {
    add(fixes, 4, scene_);
    add(fixes, 1, scene_, 1, &others);
  }
  leave_out(fixes, 4, 90);
  expect_mean_of(others, 10, fixes);
}

/// A selection on its own is the mean, and its uncertainty is the possible shift of all its fixes.
TEST_F(FixesByCaseTest, ASelectionByItselfIsAsUncertainAsItsShift) {
  FixesByCase fixes = begun(33);
  add(fixes, 4, scene_, 10);
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
TEST_F(FixesByCaseTest, ASelectionCountsByItsWeight) {
  Scene blunt = scene_;
  blunt.config.noise.sun_s *= 30.0;
  blunt.config.noise.infrared_s *= 30.0;
  FixesByCase fixes = begun(34);
  for (int i = 0; i < 100; ++i) {
    add(fixes, 1, scene_);
    add(fixes, 2, blunt);
  }
  leave_out(fixes, 1, 1);
  leave_out(fixes, 2, 900);
  const MeanOfCases mean = fixes.mean();
  EXPECT_GT(mean.settled_share, 0.98);
  EXPECT_LT(mean.covariance_rad2.trace(), 1.1 * mean.equations.covariance_rad2().trace());
}

constexpr std::size_t kStretch = 20;

/// After the geometry has changed, noise leaves no fix out. The earlier settled fixes form the
/// selection, not these.
TEST_F(FixesByCaseTest, AStretchIsNoSelectionBecauseAnEarlierOneIs) {
  FixesByCase fixes = begun(35, kStretch);
  add(fixes, 4, scene_);
  leave_out(fixes, 4, kStretch - 1);
  AngleEquations later{scene_.axis_icrf};
  add(fixes, 4, scene_, 3 * kStretch, &later);
  expect_mean_of(later, 3 * kStretch, fixes);
}

/// While a stretch has few fixes, all of them may have been settled by chance.
TEST_F(FixesByCaseTest, AStretchThatBeginsCountsWithTheOneBefore) {
  FixesByCase fixes = begun(36, kStretch);
  add(fixes, 4, scene_, kStretch / 2);
  leave_out(fixes, 4, kStretch / 2);
  add(fixes, 4, scene_);
  const MeanOfCases mean = fixes.mean();
  EXPECT_EQ(mean.count, kStretch / 2 + 1);
  EXPECT_NEAR(mean.settled_share, 11.0 / 21.0, 1e-4);
}

TEST_F(FixesByCaseTest, WhatIsTakenBackIsNotLeftOut) {
  FixesByCase fixes = begun(37);
  add(fixes, 4, scene_);
  leave_out(fixes, 4, 2);
  fixes.take_back(4, 0);
  EXPECT_NEAR(fixes.mean().settled_share, 0.5, 1e-4);
}

}  // namespace spindrift::testing::fixes_by_case_test
