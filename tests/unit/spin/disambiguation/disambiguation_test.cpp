#include "pipelines/spin/disambiguation/disambiguation.h"

#include <Eigen/Geometry>
#include <set>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "tests/support/axis_scene.h"
#include "tests/support/matchers.h"

namespace spindrift::testing::disambiguation_test {

using enum SpinQuantity;

using Scene = AxisScene;

const std::set<SpinQuantity> kDihedrals = {NorthDihedral, SouthDihedral};

/// Returns the scene with the Earth moved by this angle.
Scene moved(Scene scene, double turn_rad) {
  scene.earth_icrf = Eigen::AngleAxisd{turn_rad, Eigen::Vector3d::UnitX()} * scene.earth_icrf;
  return scene;
}

std::vector<SpinFix> settle(Disambiguator& disambiguator, const Scene& scene,
                            const Revolution& revolution, const std::set<SpinQuantity>& left_out,
                            const std::optional<KnownAxis>& established = {}) {
  const auto measured = measured_without(scene.config, revolution, left_out);
  return disambiguator.settle(revolution.number, scene.start, measured, scene.sun_earth(),
                              axis_candidates(scene.config, measured, scene.sun_earth()).value(),
                              established);
}

SpinFix settled(const Scene& scene, const Revolution& revolution,
                const std::set<SpinQuantity>& left_out,
                const std::optional<KnownAxis>& established = {}) {
  Disambiguator disambiguator{scene.config};
  return settle(disambiguator, scene, revolution, left_out, established).back();
}

struct DisambiguationTest : ::testing::Test {
  Scene scene;
};

TEST_F(DisambiguationTest, MeasurementsThatTellThemApartAreGeometryAndWithoutThemItIsAmbiguous) {
  const SpinFix told_apart = settled(scene, scene.seen(), {});
  EXPECT_EQ(told_apart.resolution, Resolution::Geometry);
  EXPECT_TRUE(told_apart.accepted);
  const SpinFix open = settled(scene, scene.seen(), kDihedrals);
  EXPECT_EQ(open.resolution, Resolution::Ambiguous);
  EXPECT_FALSE(open.accepted);
  EXPECT_EQ(open.alternates.size(), 1U);
}

/// Returns a prior whose axis is turned about ICRF y.
SpinPrior prior(const Scene& scene, double off_deg, double sigma_deg) {
  return {.axis_icrf =
              Eigen::AngleAxisd{off_deg * kRadPerDeg, Eigen::Vector3d::UnitY()} * scene.axis_icrf,
          .sigma_rad = sigma_deg * kRadPerDeg};
}

TEST_F(DisambiguationTest, ThePriorOfTheMissionChoosesTheNearest) {
  const Eigen::Vector3d off = (scene.axis_icrf + Eigen::Vector3d{0.03, 0.0, 0.0}).normalized();
  scene.config.prior = SpinPrior{.axis_icrf = off, .sigma_rad = 2.0 * kRadPerDeg};
  const SpinFix fix = settled(scene, scene.seen(), kDihedrals);
  EXPECT_EQ(fix.resolution, Resolution::Prior);
  EXPECT_TRUE(fix.accepted);
  EXPECT_LT(scene.off_rad(fix.axis_icrf), 1e-6);
}

TEST_F(DisambiguationTest, APriorFarFromAllOrTooVagueChoosesNothing) {
  scene.config.prior = prior(scene, 20.0, 2.0);
  EXPECT_EQ(settled(scene, scene.seen(), kDihedrals).resolution, Resolution::Ambiguous);
  scene.config.prior = prior(scene, 0.0, 180.0);
  EXPECT_EQ(settled(scene, scene.seen(), kDihedrals).resolution, Resolution::Ambiguous);
}

TEST_F(DisambiguationTest, WhatThePriorSaysOfTheCandidatesIsTold) {
  const auto verdict = [&](const std::optional<KnownAxis>& established = {}) {
    Disambiguator disambiguator{scene.config};
    settle(disambiguator, scene, scene.seen(), kDihedrals, established);
    return disambiguator.prior_verdict();
  };
  EXPECT_EQ(verdict(), std::nullopt);
  scene.config.prior = prior(scene, 0.0, 2.0);
  EXPECT_EQ(verdict(), PriorVerdict::Chooses);
  EXPECT_EQ(verdict(KnownAxis{.axis_icrf = scene.axis_icrf, .sigma_rad = 0.1 * kRadPerDeg}),
            std::nullopt);
  scene.config.prior->sigma_rad = 180.0 * kRadPerDeg;
  EXPECT_EQ(verdict(), PriorVerdict::NearSeveral);
  scene.config.prior = prior(scene, 20.0, 2.0);
  EXPECT_EQ(verdict(), PriorVerdict::FarFromAll);
}

TEST_F(DisambiguationTest, WhatThePassHasEstablishedTakesThePlaceOfThePrior) {
  scene.config.prior = SpinPrior{.axis_icrf = -scene.axis_icrf, .sigma_rad = 1.0 * kRadPerDeg};
  const KnownAxis known{.axis_icrf = scene.axis_icrf,
                        .sigma_rad = 0.1 * kRadPerDeg,
                        .settled_by = Resolution::Geometry};
  const SpinFix fix = settled(scene, scene.seen(), kDihedrals, known);
  EXPECT_EQ(fix.resolution, Resolution::Prior);
  EXPECT_EQ(said_resolution(fix), Resolution::Geometry);
  EXPECT_LT(scene.off_rad(fix.axis_icrf), 1e-6);
}

TEST(Disambiguation, AnAxisKnownBadlyChoosesNoneOfThoseThatGrazeBesideIt) {
  // Noise may hide the true candidate; with a sigma of 7 deg a false one soon matches.
  const Scene scene;
  const auto measured = scene.measured(kDihedrals);
  AxisCandidates found = axis_candidates(scene.config, measured, scene.sun_earth()).value();
  found.candidates.resize(1);
  const auto resolution = [&](bool near_tangent, double off_deg, double sigma_deg) {
    found.near_tangent = near_tangent;
    const Eigen::Vector3d& axis_icrf = found.candidates.front().axis_icrf;
    const KnownAxis known{
        .axis_icrf =
            Eigen::AngleAxisd{off_deg * kRadPerDeg, axis_icrf.unitOrthogonal()} * axis_icrf,
        .sigma_rad = sigma_deg * kRadPerDeg};
    return Disambiguator{scene.config}
        .settle(0, scene.start, measured, scene.sun_earth(), found, known)
        .back()
        .resolution;
  };
  EXPECT_EQ(resolution(true, 2.0, 2.0), Resolution::Prior);
  EXPECT_EQ(resolution(true, 2.0, 7.0), Resolution::Prior);
  EXPECT_EQ(resolution(true, 15.0, 7.0), Resolution::Ambiguous);
  EXPECT_EQ(resolution(false, 15.0, 7.0), Resolution::Prior);
}

TEST(Disambiguation, AHealthyBeamThatIsSilentRulesOutTheAxisThatShowsItTheEarth) {
  // The Earth, with a half-angle of 24 deg, is 100 deg from the axis, which the south beam at 70
  // deg cannot reach. The other root of north's chord has the Earth in full view of that beam.
  Scene scene;
  scene.axis_icrf = Eigen::Vector3d::UnitZ();
  scene.sun_icrf = Eigen::Vector3d{1.0, 0.6, 0.3}.normalized();
  scene.config.south->mount_angle_rad = 70.0 * kRadPerDeg;
  scene.earth_icrf = direction_icrf({.ra_rad = 1.9, .dec_rad = -10.0 * kRadPerDeg});
  scene.rate_rad_s = 1.0;
  scene.first_turn_rad = 0.0;
  const auto run = [&](bool healthy, int revolutions) {
    scene.config.south->healthy = healthy;
    Revolution revolution = scene.seen();
    EXPECT_FALSE(revolution.edge(PulseChannel::SouthIn));
    revolution.edges.at(index_of(PulseChannel::Sun2)).reset();
    const auto measured = measure(scene.config, revolution);
    const auto found = axis_candidates(scene.config, measured, scene.sun_earth()).value();
    EXPECT_GT(found.candidates.size(), 1U);
    Disambiguator disambiguator{scene.config};
    SpinFix last{};
    for (int i = 0; i < revolutions; ++i) {
      last = disambiguator.settle(i, scene.start, measured, scene.sun_earth(), found, std::nullopt)
                 .back();
    }
    return last;
  };
  EXPECT_EQ(run(true, 4).resolution, Resolution::Ambiguous);
  EXPECT_EQ(run(false, 8).resolution, Resolution::Ambiguous);
  const SpinFix fix = run(true, 5);
  EXPECT_EQ(fix.resolution, Resolution::Constraint);
  EXPECT_TRUE(fix.accepted);
  EXPECT_LT(scene.off_rad(fix.axis_icrf), 1e-5);
}

TEST(Disambiguation, AHealthyBeamThatIsSilentSpeaksAgainstTheOnlyAxisToo) {
  // From the true axis both beams see the Earth, but north is silent.
  for (const bool healthy : {true, false}) {
    Scene scene;
    scene.config.north->healthy = healthy;
    Revolution revolution = scene.seen();
    for (const PulseChannel channel : {PulseChannel::NorthIn, PulseChannel::NorthOut}) {
      revolution.edges.at(index_of(channel)).reset();
    }
    Disambiguator disambiguator{scene.config};
    for (int i = 0; i < 8; ++i) {
      const SpinFix fix = settle(disambiguator, scene, revolution, {}).back();
      EXPECT_EQ(fix.resolution, Resolution::Geometry);
      EXPECT_NE(fix.accepted, healthy) << i;
      EXPECT_EQ(disambiguator.silent_despite_view(),
                healthy ? std::optional{Side::North} : std::nullopt);
    }
    EXPECT_TRUE(settle(disambiguator, scene, scene.seen(), {}).back().accepted);
    // A beam that was received before may miss a revolution.
    EXPECT_TRUE(settle(disambiguator, scene, revolution, {}).back().accepted);
  }
}

TEST_F(DisambiguationTest, DispersionSettlesTheEarlierFixesOfItsWindowToo) {
  Disambiguator disambiguator{scene.config};
  std::set<std::int64_t> ambiguous;
  bool settled_earlier = false;
  int told = 0;
  for (int number = 0; number < 60; ++number) {
    const Scene there = moved(scene, 0.25 * kRadPerDeg * number);
    Revolution revolution = there.seen();
    revolution.number = number;
    const auto fixes = settle(disambiguator, there, revolution, kDihedrals);
    ASSERT_EQ(fixes.back().revolution, number);
    if (const auto& steady = disambiguator.newly_stationary()) {
      ++told;
      EXPECT_GT(fixes.size(), 1U) << "with the fixes that it settles";
      EXPECT_LT(scene.off_rad(steady->axis.axis_icrf), 1e-5);
      EXPECT_GT(steady->scatter_ratio, 1.0);
    }
    if (fixes.back().resolution == Resolution::Ambiguous) {
      ASSERT_FALSE(settled_earlier) << number;
      ambiguous.insert(number);
      continue;
    }
    for (const SpinFix& fix : fixes) {
      EXPECT_EQ(fix.resolution, Resolution::Dispersion);
      EXPECT_TRUE(fix.accepted);
      EXPECT_LT(scene.off_rad(fix.axis_icrf), 1e-5);
      ambiguous.erase(fix.revolution);
    }
    settled_earlier = settled_earlier || fixes.size() > 1;
  }
  EXPECT_TRUE(settled_earlier);
  EXPECT_EQ(told, 1);
  EXPECT_TRUE(ambiguous.empty());
}

TEST_F(DisambiguationTest, MeasurementsThatContradictEachOtherAreNeverAccepted) {
  scene.config.prior = prior(scene, 0.0, 2.0);
  const auto measured = scene.measured(kDihedrals);
  SunEarthDirections sun_earth = scene.sun_earth();
  sun_earth.disc_rad *= 1.25;
  const auto found = axis_candidates(scene.config, measured, sun_earth).value();
  const SpinFix fix = Disambiguator{scene.config}
                          .settle(0, scene.start, measured, sun_earth, found, std::nullopt)
                          .back();
  EXPECT_EQ(fix.resolution, Resolution::Ambiguous);
  EXPECT_FALSE(fix.accepted);
}

}  // namespace spindrift::testing::disambiguation_test
