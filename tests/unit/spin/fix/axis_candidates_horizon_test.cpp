#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <set>
#include <vector>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/spin/fix/axis_candidates.h"
#include "tests/support/axis_scene.h"
#include "tests/support/matchers.h"

namespace spindrift::testing::axis_candidates_horizon_test {

using Scene = AxisScene;
using enum SpinQuantity;

/// Quantities left out: none, and either chord.
const std::array<std::set<SpinQuantity>, 3> kLeftOut = {std::set<SpinQuantity>{},
                                                        std::set{SouthChord}, std::set{NorthChord}};

std::vector<Scene> usual_scenes(HorizonModel earth) {
  std::vector<Scene> scenes;
  for (const double tilt_deg : {0.0, 20.0, 40.0, 60.0, 80.0}) {
    for (const double earth_angle_deg : {80.0, 90.0, 97.0}) {
      scenes.push_back(tilted_scene(tilt_deg, earth_angle_deg, earth));
    }
  }
  return scenes;
}

class FixesOnHorizons : public ::testing::TestWithParam<HorizonModel> {};

TEST_P(FixesOnHorizons, ExactEdgesGiveTheTrueAxis) {
  for (const Scene& scene : usual_scenes(GetParam())) {
    for (const auto& left_out : kLeftOut) {
      const SpinFix fix = scene.fix(left_out).value();
      EXPECT_TRUE(fix.accepted);
      EXPECT_LT(scene.off_rad(fix.axis_icrf), kExact_rad);
      EXPECT_NEAR(fix.norm, 1.0, kExact_rad);
    }
  }
}

TEST_P(FixesOnHorizons, TakingItForTheOtherCostsWhatTheDesignSays) {
  double squares = 0.0;
  int fixes = 0;
  for (Scene scene : usual_scenes(GetParam())) {
    scene.config.horizon.model =
        GetParam() == HorizonModel::Sphere ? HorizonModel::Ellipsoid : HorizonModel::Sphere;
    for (const auto& left_out : kLeftOut) {
      squares +=
          std::pow(angle_between_rad(scene.fix(left_out).value().axis_icrf, scene.axis_icrf), 2);
      ++fixes;
    }
  }
  const double off_deg = std::sqrt(squares / fixes) / kRadPerDeg;
  EXPECT_GT(off_deg, 0.03);
  EXPECT_LT(off_deg, 0.11);
}

TEST_P(FixesOnHorizons, ExactEdgesGiveTheTrueAxisWhileTheEarthMoves) {
  const Eigen::Vector3d motion_icrf_s{-5e-4, 1e-4, 2e-4};  // The Earth moves at 0.03 deg/s.
  for (const Scene& scene : usual_scenes(GetParam())) {
    const Revolution seen = scene.seen_while_earth_moves(motion_icrf_s);
    const SunEarthDirections sun_earth = scene.sightlines_while_earth_moves(motion_icrf_s);
    for (const auto& left_out : kLeftOut) {
      const SpinFix fix = lone_fix(scene.config, seen, left_out, sun_earth).value();
      EXPECT_LT(scene.off_rad(fix.axis_icrf), kExact_rad);
    }
  }
}

TEST_P(FixesOnHorizons, AFixTurnsWithAllThatItWasMadeFrom) {
  std::mt19937_64 rng{94};
  std::normal_distribution<double> normal;
  for (const Scene& scene : usual_scenes(GetParam())) {
    const Revolution seen = noisy(scene, scene.seen(), rng);
    const double w = normal(rng);
    const double x = normal(rng);
    const double y = normal(rng);
    const Eigen::Quaterniond turn = Eigen::Quaterniond{w, x, y, normal(rng)}.normalized();
    const SunEarthDirections sun_earth = scene.sightlines_while_earth_moves({1e-4, 2e-4, -3e-4});
    SunEarthDirections turned = sun_earth;
    for (Eigen::Vector3d SunEarthDirections::*direction :
         {&SunEarthDirections::sun_icrf, &SunEarthDirections::earth_icrf,
          &SunEarthDirections::earth_pole_icrf, &SunEarthDirections::earth_motion_icrf_s}) {
      turned.*direction = turn * (sun_earth.*direction);
    }
    for (const auto& left_out : kLeftOut) {
      const SpinFix fix = lone_fix(scene.config, seen, left_out, sun_earth).value();
      const SpinFix there = lone_fix(scene.config, seen, left_out, turned).value();
      EXPECT_LT(angle_between_rad(there.axis_icrf, turn * fix.axis_icrf), 1e-10);
      EXPECT_NEAR(there.norm, fix.norm, 1e-10);
      EXPECT_NEAR(there.covariance_rad2.trace() / fix.covariance_rad2.trace(), 1.0, 1e-6);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(AxisCandidates, FixesOnHorizons,
                         ::testing::Values(HorizonModel::Sphere, HorizonModel::Ellipsoid),
                         [](const auto& model) {
                           return model.param == HorizonModel::Sphere ? "Sphere" : "Ellipsoid";
                         });

TEST(AxisCandidatesOnTheEllipsoid, ABeamThatOnTheSphereWouldMissItHasAFixToo) {
  // Seen from the equator, the beam passes 0.1 to 0.3 deg below the pole's limb. The sphere's limb
  // is 0.09 deg higher, and the axis found with it has the beam pass above the pole.
  const double limb_rad = std::atan(
      6396.752314245 / std::sqrt(Scene::kRange_km * Scene::kRange_km - 6418.137 * 6418.137));
  for (const double tilt_deg : {0.0, 10.0}) {
    for (const double depth_deg : {0.1, 0.2, 0.3}) {
      Scene scene = tilted_scene(tilt_deg, 90.0, HorizonModel::Ellipsoid);
      scene.config.noise = {.sun_s = 2e-6, .infrared_s = 2e-6};
      scene.config.north->mount_angle_rad =
          0.5 * std::numbers::pi - limb_rad + depth_deg * kRadPerDeg;
      const SpinFix fix = scene.fix({SouthChord, SouthDihedral}).value();
      EXPECT_EQ(fix.geometry_case, 2);
      EXPECT_LT(scene.off_rad(fix.axis_icrf), 0.0005 * kRadPerDeg) << tilt_deg << " " << depth_deg;
    }
  }
}

void mount_for_chord(double chord_rad, Scene& scene) {
  const double earth_angle_rad = angle_between_rad(scene.axis_icrf, scene.earth_icrf);
  double narrower_rad = earth_angle_rad - 30.0 * kRadPerDeg;
  double wider_rad = earth_angle_rad - 15.0 * kRadPerDeg;
  for (int i = 0; i < 30; ++i) {
    scene.config.north->mount_angle_rad = 0.5 * (narrower_rad + wider_rad);
    const auto crossing = scene.measured().crossing(Side::North);
    const bool wider = crossing && crossing->chord && crossing->chord->value_rad > chord_rad;
    (wider ? wider_rad : narrower_rad) = scene.config.north->mount_angle_rad;
  }
  scene.config.north->mount_angle_rad = wider_rad;
}

TEST(AxisCandidatesOnTheEllipsoid, ANarrowChordAnywhereOnTheLimbHasAFixToo) {
  for (const double tilt_deg : {0.0, 30.0, 60.0, 90.0}) {
    for (const double earth_angle_deg : {80.0, 90.0, 105.0}) {
      for (const double chord_deg : {1.0, 2.0, 3.0, 4.0}) {
        Scene scene = tilted_scene(tilt_deg, earth_angle_deg, HorizonModel::Ellipsoid);
        scene.config.noise = {.sun_s = 2e-6, .infrared_s = 2e-6};
        mount_for_chord(chord_deg * kRadPerDeg, scene);
        for (const auto& left_out : {std::set{SouthChord, SouthDihedral},
                                     std::set{SouthChord, SouthDihedral, NorthDihedral}}) {
          const auto found =
              axis_candidates(scene.config, scene.measured(left_out), scene.sun_earth()).value();
          double off_rad = 1.0;
          for (const AxisCandidate& candidate : found.candidates) {
            off_rad = std::min(off_rad, scene.off_rad(candidate.axis_icrf));
          }
          EXPECT_LT(off_rad, 0.0002 * kRadPerDeg)
              << tilt_deg << " " << earth_angle_deg << " " << chord_deg;
        }
      }
    }
  }
}

TEST(AxisCandidatesOnTheEllipsoid, RootsThatOnlyTheSphereAllowsAreNone) {
  // Seen from pole to pole, the sphere's chord is wider than any on the ellipsoid.
  Scene scene = tilted_scene(90.0, 89.5, HorizonModel::Sphere);
  scene.config.north->mount_angle_rad = 0.5 * std::numbers::pi;
  scene.config.south.reset();
  const RevolutionMeasurements measured = scene.measured({SunAngle});
  const auto candidates = [&] {
    return axis_candidates(scene.config, measured, scene.sun_earth());
  };
  EXPECT_FALSE(candidates().value().candidates.empty());
  scene.config.horizon.model = HorizonModel::Ellipsoid;
  const auto found = candidates();
  ASSERT_FALSE(found);
  EXPECT_FALSE(found.error().contradictory);
  EXPECT_EQ(found.error().why.code, NoFixCode::ChordTooWide);
}

}  // namespace spindrift::testing::axis_candidates_horizon_test
