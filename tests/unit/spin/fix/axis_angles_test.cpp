#include "pipelines/spin/fix/axis_angles.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <set>
#include <vector>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "tests/support/axis_scene.h"
#include "tests/support/matchers.h"

namespace spindrift::testing::axis_angles_test {

using Scene = AxisScene;
using enum SpinQuantity;

/// Returns the dihedral from the Sun's half-plane to the Earth's about the axis, [0, 2 pi).
double dihedral_rad(const Scene& scene) {
  const double dihedral = std::atan2(
      scene.axis_icrf.dot(scene.sun_icrf.cross(scene.earth_icrf)),
      scene.axis_icrf.cross(scene.sun_icrf).dot(scene.axis_icrf.cross(scene.earth_icrf)));
  return dihedral < 0.0 ? dihedral + 2.0 * std::numbers::pi : dihedral;
}

/// Returns the distance of the solution from the angles of the true vectors.
double distance_rad(const Scene& scene, const AxisAngles& place) {
  const double off[] = {
      place.sun_angle_rad.value() - angle_between_rad(scene.axis_icrf, scene.sun_icrf),
      place.earth_angle_rad.value() - angle_between_rad(scene.axis_icrf, scene.earth_icrf),
      std::remainder(place.dihedral_rad.value() - dihedral_rad(scene), 2.0 * std::numbers::pi)};
  return std::hypot(off[0], off[1], off[2]);
}

struct Solved {
  AxisSolutions found;
  double nearest_rad;
};

Solved solved(const Scene& scene, const std::set<SpinQuantity>& left_out) {
  const RevolutionMeasurements measured = scene.measured(left_out);
  const auto sun_earth = scene.sun_earth();
  const FixInput input = fix_input(scene.config, measured, sun_earth, views_of_sphere(sun_earth));
  Solved solved{.found = solve_axis_angles(input), .nearest_rad = 10.0};
  for (const AxisAngles& place : solved.found.places) {
    solved.nearest_rad = std::min(solved.nearest_rad, distance_rad(scene, place));
  }
  rank(input, solved.found);
  return solved;
}

const std::vector<std::set<SpinQuantity>> kLosses = {
    {},         {SouthChord},           {NorthChord},          {NorthDihedral, SouthDihedral},
    {SunAngle}, {SunAngle, SouthChord}, {SunAngle, NorthChord}};

/// The scene has right angles; the expected values are worked out by hand.
TEST(AxisAngles, OfABodyUprightBetweenSunAndEarth) {
  Scene scene;
  scene.axis_icrf = Eigen::Vector3d::UnitZ();
  scene.sun_icrf = Eigen::Vector3d::UnitX();
  scene.earth_icrf = Eigen::Vector3d::UnitY();
  for (const auto& left_out : {std::set<SpinQuantity>{}, std::set{SouthChord}}) {
    const AxisSolutions found = solved(scene, left_out).found;
    ASSERT_FALSE(found.places.empty());
    const AxisAngles& best = found.places.front();
    EXPECT_NEAR(best.sun_angle_rad.value(), 90.0 * kRadPerDeg, kExact_rad);
    EXPECT_NEAR(best.earth_angle_rad.value(), 90.0 * kRadPerDeg, kExact_rad);
    EXPECT_NEAR(best.dihedral_rad.value(), 90.0 * kRadPerDeg, kExact_rad);
  }
}

TEST(AxisAngles, AreThoseOfTheVectorsWhateverIsMissing) {
  const Scene scene;
  for (std::size_t i = 0; i < kLosses.size(); ++i) {
    SCOPED_TRACE(i);
    EXPECT_LT(solved(scene, kLosses[i]).nearest_rad, kExact_rad);
  }
}

TEST(AxisAngles, AreThoseOfTheVectorsAnywhere) {
  std::mt19937_64 rng{51};
  std::uniform_real_distribution<double> tilt{-0.08, 0.08};
  int tried = 0;
  for (int trial = 0; trial < 200; ++trial) {
    Scene scene;
    scene.axis_icrf = (scene.axis_icrf + Eigen::Vector3d{tilt(rng), tilt(rng), 0.0}).normalized();
    for (std::size_t i = 0; i < kLosses.size(); ++i) {
      SCOPED_TRACE(i);
      const Solved answer = solved(scene, kLosses[i]);
      if (answer.found.places.empty() || answer.found.near_tangent) {
        continue;
      }
      // Near a double root the error grows as the square root of the 1 ns resolution.
      EXPECT_LT(answer.nearest_rad, 1e3 * kExact_rad) << trial;
      ++tried;
    }
  }
  EXPECT_GT(tried, 1000);
}

/// The derivatives are compared with a north_in that is later by one standard deviation.
TEST(AxisAngles, CarryWhatEachEdgeMovesThemBy) {
  const Scene scene;
  const auto sun_earth = scene.sun_earth();
  const auto solve = [&](double later_s) {
    Revolution revolution = scene.seen();
    auto& edge = revolution.edges.at(index_of(PulseChannel::NorthIn));
    edge = shifted(*edge, later_s);
    const RevolutionMeasurements measured = measure(scene.config, revolution);
    return solve_axis_angles(
               fix_input(scene.config, measured, sun_earth, views_of_sphere(sun_earth)))
        .places.front();
  };
  const double sigma_s = scene.config.noise.infrared_s;
  const AxisAngles late = solve(sigma_s);
  const AxisAngles early = solve(-sigma_s);
  const AxisAngles exact = solve(0.0);
  const auto by_edge = [](const Uncertain& angle) {
    return angle.derivatives()(static_cast<Eigen::Index>(index_of(PulseChannel::NorthIn)));
  };
  // The error of central differences is the third order of the step of 5e-4 rad, amplified tenfold.
  EXPECT_NEAR(by_edge(exact.earth_angle_rad),
              0.5 * (late.earth_angle_rad.value() - early.earth_angle_rad.value()), 1e-6);
  EXPECT_NEAR(by_edge(exact.dihedral_rad),
              0.5 * (late.dihedral_rad.value() - early.dihedral_rad.value()), 1e-6);
  EXPECT_EQ(by_edge(exact.sun_angle_rad), 0.0);
}

TEST(AxisAngles, BothChordsAreToldApartAndOneOfTwoRootsIsRankedFirst) {
  const Scene scene;
  const Solved both = solved(scene, {});
  EXPECT_EQ(both.found.places.size(), 1U);
  EXPECT_TRUE(both.found.told_apart);
  for (const SpinQuantity lost : {SouthChord, NorthChord}) {
    const Solved one = solved(scene, {lost});
    ASSERT_FALSE(one.found.places.empty());
    EXPECT_LT(distance_rad(scene, one.found.places.front()), kExact_rad);
  }
}

}  // namespace spindrift::testing::axis_angles_test
