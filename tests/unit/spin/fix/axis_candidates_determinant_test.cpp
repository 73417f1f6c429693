#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/spin/fix/axis_candidates.h"
#include "tests/support/axis_scene.h"

namespace spindrift::axis_candidates_determinant_test {

using testing::kExact_rad;
using Scene = testing::AxisScene;

constexpr double kPi = std::numbers::pi;

/// Returns a scene with Delta = `determinant`: the Sun is on the equator, the Earth behind it by a
/// dihedral with the cosine `determinant` / cos(85 deg).
Scene scene_of_determinant(double determinant, double earth_angle_deg = 87.0) {
  const double dihedral_rad = std::acos(determinant / std::cos(85.0 * kRadPerDeg));
  const double earth_angle_rad = earth_angle_deg * kRadPerDeg;
  Scene scene{.sun_icrf = Eigen::Vector3d::UnitX(), .axis_icrf = Eigen::Vector3d::UnitZ()};
  scene.earth_icrf =
      direction_icrf({.ra_rad = dihedral_rad, .dec_rad = 0.5 * kPi - earth_angle_rad});
  scene.config.south.reset();
  return scene;
}

TEST(AxisCandidates, ALargeDeterminantLeavesNoAlternate) {
  for (const double delta : {0.0302, 0.05, -0.0302, -0.05}) {
    const Scene scene = scene_of_determinant(delta);
    const SpinFix fix = scene.fix().value();
    EXPECT_TRUE(fix.alternates.empty()) << delta;
    EXPECT_EQ(fix.resolution, Resolution::Geometry);
    EXPECT_LT(angle_between_rad(fix.axis_icrf, scene.axis_icrf), kExact_rad);
  }
}

TEST(AxisCandidates, ASmallDeterminantLeavesTheOtherRootAsAlternate) {
  for (const double delta : {0.0298, -0.02, -0.0298}) {
    // The roots are 15 deg on either side of the beam; noise and model errors move them only
    // slightly.
    const Scene scene = scene_of_determinant(delta, 70.0);
    const SpinFix fix = scene.fix().value();
    EXPECT_EQ(fix.resolution, Resolution::Geometry) << delta;
    EXPECT_TRUE(fix.accepted);
    EXPECT_LT(angle_between_rad(fix.axis_icrf, scene.axis_icrf), kExact_rad);
    ASSERT_EQ(fix.alternates.size(), 1);
    EXPECT_GT(angle_between_rad(fix.alternates.front().axis_icrf, scene.axis_icrf), kRadPerDeg);
  }
}

TEST(AxisCandidates, RootsThatTheModelMayExchangeAreAmbiguous) {
  // The roots are 2 deg on either side of the beam, where a limb error of 0.15 deg moves them as
  // far.
  for (const double delta : {0.0298, 0.02, -0.02, -0.0298}) {
    const SpinFix fix = scene_of_determinant(delta).fix().value();
    EXPECT_EQ(fix.resolution, Resolution::Ambiguous) << delta;
    EXPECT_EQ(fix.alternates.size(), 1);
  }
}

TEST(AxisCandidates, AVanishingDeterminantIsAmbiguousAndNotAccepted) {
  for (const double delta : {0.0098, 0.0, -0.0098}) {
    const Scene scene = scene_of_determinant(delta);
    const SpinFix fix = scene.fix().value();
    EXPECT_EQ(fix.resolution, Resolution::Ambiguous) << delta;
    EXPECT_FALSE(fix.accepted);
    EXPECT_EQ(fix.geometry_case, 2);
    ASSERT_EQ(fix.alternates.size(), 1);
    const double off_rad = angle_between_rad(fix.axis_icrf, scene.axis_icrf);
    const double alternate_off_rad =
        angle_between_rad(fix.alternates.front().axis_icrf, scene.axis_icrf);
    EXPECT_LT(std::min(off_rad, alternate_off_rad), kExact_rad);
    EXPECT_GT(std::max(off_rad, alternate_off_rad), kRadPerDeg);
  }
}

TEST(AxisCandidates, ARootThatFitsBetterByNoiseAloneIsNotAccepted) {
  std::mt19937_64 rng{5};
  for (const double delta : {0.012, 0.02, 0.028, 0.035}) {
    Scene scene = scene_of_determinant(delta);
    scene.sun_icrf = Eigen::Vector3d{1.0, 0.0, 0.5}.normalized();
    scene.rate_rad_s = 2.0 * kPi;
    scene.config.noise.infrared_s = 1.5e-3;
    const Revolution exact = scene.seen();
    for (int draw = 0; draw < 300; ++draw) {
      const auto fix =
          testing::lone_fix(scene.config, testing::noisy(scene, exact, rng), {}, scene.sun_earth());
      if (fix && fix->accepted) {
        const double sigma_rad = std::sqrt(fix->covariance_rad2.trace());
        EXPECT_LT(angle_between_rad(fix->axis_icrf, scene.axis_icrf), 6.0 * sigma_rad) << delta;
      }
    }
  }
}

TEST(AxisCandidates, ARootOfANarrowChordIsNotAcceptedByNoiseAlone) {
  // The roots are 47 deg apart and fit the angle between Sun and Earth almost alike. For the fast
  // body the noise is a tenth of the chord and more.
  std::mt19937_64 rng{6};
  int accepted = 0;
  for (const double delta : {0.012, 0.016, 0.02, 0.028}) {
    for (const double inside_deg : {0.05, 0.1, 0.2, 0.4}) {
      Scene scene;
      const double disc_deg = scene.sun_earth().disc_rad / kRadPerDeg;
      scene = scene_of_determinant(delta, 85.0 + disc_deg - inside_deg);
      scene.rate_rad_s = 2.5 * 2.0 * kPi;
      const Revolution exact = scene.seen();
      for (int draw = 0; draw < 300; ++draw) {
        const auto fix = testing::lone_fix(scene.config, testing::noisy(scene, exact, rng), {},
                                           scene.sun_earth());
        if (fix && fix->accepted && !fix->near_tangent) {
          const double sigma_rad = std::sqrt(fix->covariance_rad2.trace());
          EXPECT_LT(angle_between_rad(fix->axis_icrf, scene.axis_icrf), 6.0 * sigma_rad)
              << delta << ' ' << inside_deg;
          ++accepted;
        }
      }
    }
  }
  EXPECT_GT(accepted, 100);
}

TEST(AxisCandidates, LimitsOfTheDeterminantAreThoseOfTheMission) {
  Scene scene = scene_of_determinant(0.05);
  scene.config.geometry = {.determinant_usable = 0.08, .determinant_ambiguous = 0.06};
  EXPECT_EQ(scene.fix().value().resolution, Resolution::Ambiguous);
  scene.config.geometry = {.determinant_usable = 0.08, .determinant_ambiguous = 0.04};
  EXPECT_FALSE(scene.fix().value().alternates.empty());
  scene.config.geometry = {.determinant_usable = 0.04, .determinant_ambiguous = 0.01};
  EXPECT_TRUE(scene.fix().value().alternates.empty());
}

TEST(AxisCandidates, AChordWiderThanTheDiscIsRefusedWithItsMeasure) {
  Scene scene = scene_of_determinant(0.02);
  Revolution revolution = scene.seen();
  const TaiTime in = revolution.edge(PulseChannel::NorthIn).value();
  revolution.edges.at(index_of(PulseChannel::NorthOut)) = shifted(in, 0.9 / scene.rate_rad_s);
  const auto fix = testing::lone_fix(scene.config, revolution, {}, scene.sun_earth());
  ASSERT_FALSE(fix);
  EXPECT_TRUE(fix.error().contradictory);
  EXPECT_EQ(fix.error().why.code, NoFixCode::ChordTooWide);
  const NamedValue& chord = fix.error().why.values.front();
  EXPECT_EQ(chord.name, "chord_deg");
  EXPECT_NEAR(std::get<double>(chord.value), 51.5662, 1e-4);
}

TEST(AxisCandidates, ASolutionThatTheNoiseDestroysIsRefused) {
  // At its widest the chord has a double root, to which every edge has an unbounded effect.
  Scene scene = scene_of_determinant(0.02);
  scene.earth_icrf = direction_icrf(
      {.ra_rad = std::acos(0.02 / std::cos(85.0 * kRadPerDeg)), .dec_rad = 5.0 * kRadPerDeg});
  scene.config.noise.infrared_s = 5e-2;
  const auto fix = scene.fix();
  ASSERT_FALSE(fix);
  EXPECT_FALSE(fix.error().contradictory);
}

}  // namespace spindrift::axis_candidates_determinant_test
