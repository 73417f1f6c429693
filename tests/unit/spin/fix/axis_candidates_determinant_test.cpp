#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/spin/fix/axis_candidates.h"
#include "tests/support/axis_scene.h"
#include "tests/support/matchers.h"

namespace spindrift::testing::axis_candidates_determinant_test {

using Scene = AxisScene;

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

/// Describes what becomes of the two roots that one chord leaves.
struct Roots {
  std::vector<double> deltas;
  double earth_angle_deg;
  Resolution resolution;
  bool both;  ///< Whether the other root is an alternate.
};

TEST(AxisCandidates, TheDeterminantSaysWhetherTheRootsAreToldApart) {
  using enum Resolution;
  const std::vector<Roots> all = {
      {{0.0302, 0.05, -0.0302, -0.05}, 87.0, Geometry, false},
      // The roots are 15 deg on either side of the beam; noise and model errors move them only
      // slightly.
      {{0.0298, -0.02, -0.0298}, 70.0, Geometry, true},
      // The roots are 2 deg on either side of the beam, where a limb error of 0.15 deg moves them
      // as far; with a vanishing determinant nothing tells them apart.
      {{0.0298, 0.02, -0.02, -0.0298, 0.0098, 0.0, -0.0098}, 87.0, Ambiguous, true}};
  for (const Roots& roots : all) {
    for (const double delta : roots.deltas) {
      SCOPED_TRACE(delta);
      const Scene scene = scene_of_determinant(delta, roots.earth_angle_deg);
      const SpinFix fix = scene.fix().value();
      EXPECT_EQ(fix.resolution, roots.resolution);
      EXPECT_EQ(fix.accepted, roots.resolution == Geometry);
      EXPECT_EQ(fix.geometry_case, 2);
      ASSERT_EQ(fix.alternates.size(), roots.both ? 1U : 0U);
      double nearest_rad = scene.off_rad(fix.axis_icrf);
      if (roots.both) {
        const double other_rad = scene.off_rad(fix.alternates.front().axis_icrf);
        EXPECT_GT(std::max(nearest_rad, other_rad), kRadPerDeg);
        EXPECT_TRUE(roots.resolution != Geometry || nearest_rad < other_rad);
        nearest_rad = std::min(nearest_rad, other_rad);
      }
      EXPECT_LT(nearest_rad, kExact_rad);
    }
  }
}

/// Expects no fix of three hundred noisy revolutions to be accepted far from the true axis.
/// @return Number of accepted fixes that are not near tangent.
int accepted_of_noise(const Scene& scene, std::mt19937_64& rng) {
  const Revolution exact = scene.seen();
  int accepted = 0;
  for (int draw = 0; draw < 300; ++draw) {
    const auto fix = lone_fix(scene.config, noisy(scene, exact, rng), {}, scene.sun_earth());
    if (fix && fix->accepted) {
      accepted += fix->near_tangent ? 0 : 1;
      EXPECT_TRUE(fix->near_tangent ||
                  scene.off_rad(fix->axis_icrf) < 6.0 * std::sqrt(fix->covariance_rad2.trace()));
    }
  }
  return accepted;
}

TEST(AxisCandidates, ARootThatFitsBetterByNoiseAloneIsNotAccepted) {
  std::mt19937_64 rng{5};
  for (const double delta : {0.012, 0.02, 0.028, 0.035}) {
    SCOPED_TRACE(delta);
    Scene scene = scene_of_determinant(delta);
    scene.sun_icrf = Eigen::Vector3d{1.0, 0.0, 0.5}.normalized();
    scene.rate_rad_s = 2.0 * kPi;
    scene.config.noise.infrared_s = 1.5e-3;
    accepted_of_noise(scene, rng);
  }
}

TEST(AxisCandidates, ARootOfANarrowChordIsNotAcceptedByNoiseAlone) {
  // The roots are 47 deg apart and fit the angle between Sun and Earth almost alike. For the fast
  // body the noise is a tenth of the chord and more.
  std::mt19937_64 rng{6};
  int accepted = 0;
  for (const double delta : {0.012, 0.016, 0.02, 0.028}) {
    for (const double inside_deg : {0.05, 0.1, 0.2, 0.4}) {
      SCOPED_TRACE(::testing::Message() << delta << ' ' << inside_deg);
      const double disc_deg = Scene{}.sun_earth().disc_rad / kRadPerDeg;
      Scene scene = scene_of_determinant(delta, 85.0 + disc_deg - inside_deg);
      scene.rate_rad_s = 2.5 * 2.0 * kPi;
      accepted += accepted_of_noise(scene, rng);
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
  const auto fix = lone_fix(scene.config, revolution, {}, scene.sun_earth());
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

}  // namespace spindrift::testing::axis_candidates_determinant_test
