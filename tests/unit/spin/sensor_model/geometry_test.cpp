#include "pipelines/spin/sensor_model/geometry.h"

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <tuple>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "tests/support/matchers.h"
#include "tests/support/spinning_body.h"

namespace spindrift::testing::geometry_test {

constexpr double kPi = std::numbers::pi;
// Half a unit of the ninth decimal of a degree, the precision of the golden values.
constexpr double kPrinted_rad = 0.5e-9 * kRadPerDeg;
// Some tens of ulps of a number of order 1, for well-conditioned formulas.
constexpr double kRounding = 1e-14;

Eigen::Vector3d at_deg(double ra_deg, double dec_deg) {
  return direction_icrf({.ra_rad = ra_deg * kRadPerDeg, .dec_rad = dec_deg * kRadPerDeg});
}

// Two cones that intersect in two axes, computed with 30 digits in mpmath. The reference prints the
// false right ascension as ...408178 instead of ...41808, where its own cones do not intersect.
const Eigen::Vector3d kSun_icrf = at_deg(10.0, 4.3);
const Eigen::Vector3d kEarth_icrf = at_deg(80.0, -20.0);
const Eigen::Vector3d kAxis_icrf = at_deg(268.625, 68.4485);
const Eigen::Vector3d kFalseAxis_icrf = at_deg(281.751608418, -23.899303556);
constexpr double kSunAngle_rad = 90.143759304 * kRadPerDeg;
constexpr double kEarthAngle_rad = 131.253314001 * kRadPerDeg;
constexpr double kDihedral_rad = 67.046435278 * kRadPerDeg;

TEST(SpinGeometry, PredictsTheAnglesOfBothAxesOfTheConesAndRecoversThem) {
  const Eigen::Vector3d normal = kSun_icrf.cross(kEarth_icrf).normalized();
  const Eigen::Vector3d mirrored = kAxis_icrf - 2.0 * normal.dot(kAxis_icrf) * normal;
  // The false axis has the same cones and the opposite dihedral.
  for (const auto& [known_icrf, image_icrf, dihedral_rad, printed] :
       {std::tuple{kAxis_icrf, kAxis_icrf, kDihedral_rad, kPrinted_rad},
        std::tuple{kFalseAxis_icrf, mirrored, -kDihedral_rad, 2.0 * kPrinted_rad}}) {
    SCOPED_TRACE(dihedral_rad);
    const PredictedAngles angles = predict_angles(known_icrf, kSun_icrf, kEarth_icrf);
    EXPECT_NEAR(angles.sun_angle_rad, kSunAngle_rad, printed);
    EXPECT_NEAR(angles.earth_angle_rad, kEarthAngle_rad, printed);
    EXPECT_NEAR(angles.dihedral_rad, dihedral_rad, printed);
    const Eigen::Vector3d axis = axis_icrf(AxisInput<double>{.sun_icrf = kSun_icrf,
                                                             .earth_icrf = kEarth_icrf,
                                                             .sun_angle_rad = kSunAngle_rad,
                                                             .earth_angle_rad = kEarthAngle_rad,
                                                             .dihedral_rad = dihedral_rad});
    EXPECT_NEAR(axis.norm(), 1.0, 4.0 * kPrinted_rad);
    EXPECT_LT(angle_between_rad(axis, known_icrf), 4.0 * kPrinted_rad);
    EXPECT_LT(angle_between_rad(axis, image_icrf), 4.0 * kPrinted_rad);
  }
}

TEST(SpinGeometry, AnglesThatContradictEachOtherShowInTheLengthOfTheAxis) {
  // With Sun and Earth 90 deg apart and both 60 deg from the axis, the squared length is 1/4 + 1/4
  // + (3/4 sin(lambda))^2, which is 1 only for cos(lambda) = -1/3.
  const auto length_at = [](double dihedral_rad) {
    return axis_icrf(AxisInput<double>{.sun_icrf = Eigen::Vector3d::UnitX(),
                                       .earth_icrf = Eigen::Vector3d::UnitY(),
                                       .sun_angle_rad = kPi / 3.0,
                                       .earth_angle_rad = kPi / 3.0,
                                       .dihedral_rad = dihedral_rad})
        .norm();
  };
  EXPECT_NEAR(length_at(std::acos(-1.0 / 3.0)), 1.0, kRounding);
  EXPECT_NEAR(length_at(kPi / 2.0), std::sqrt(1.0625), kRounding);
  EXPECT_NEAR(length_at(0.0), std::sqrt(0.5), kRounding);
}

TEST(SpinGeometry, TheDiscOfAFarEarthIsItsRadiusOverItsRange) {
  // asin(6418.137 / 42164.17) from an independent calculator.
  EXPECT_NEAR(earth_disc_half_angle_rad(42164.17, 40.0).value(), std::asin(6418.137 / 42164.17),
              kRounding);
  EXPECT_NEAR(earth_disc_half_angle_rad(2.0 * 6378.137, 0.0).value(), kPi / 6.0, kRounding);
}

TEST(SpinGeometry, ASpacecraftWithinTheHorizonHasNoDisc) {
  for (const double range_km : {6418.137, 6000.0, 0.0, -1.0, std::nan("")}) {
    EXPECT_THAT(earth_disc_half_angle_rad(range_km, 40.0),
                IsRefused(ErrorCode::Unobservable, HasSubstr("6418.137 km")))
        << range_km;
  }
}

TEST(SpinGeometry, TwoEqualChordsAboutTheEquatorMeanAnEarthOnItAndTheOrderDoesNotMatter) {
  const Chord north{.mount_angle_rad = 80.0 * kRadPerDeg, .chord_rad = 0.3};
  const Chord south{.mount_angle_rad = 100.0 * kRadPerDeg, .chord_rad = 0.3};
  EXPECT_NEAR(earth_angle_from_two_chords(north, south), kPi / 2.0, kRounding);
  const Chord one{.mount_angle_rad = 85.0 * kRadPerDeg, .chord_rad = 0.31};
  const Chord other{.mount_angle_rad = 97.0 * kRadPerDeg, .chord_rad = 0.22};
  EXPECT_NEAR(earth_angle_from_two_chords(one, other), earth_angle_from_two_chords(other, one),
              kRounding);
}

TEST(SpinGeometry, BeamsLessThanAHundredthApartAreMountedAlike) {
  EXPECT_TRUE(mount_angles_coincide(85.0 * kRadPerDeg, 85.0 * kRadPerDeg));
  EXPECT_TRUE(mount_angles_coincide(89.8 * kRadPerDeg, 90.3 * kRadPerDeg));
  EXPECT_FALSE(mount_angles_coincide(89.7 * kRadPerDeg, 90.3 * kRadPerDeg));
  EXPECT_FALSE(mount_angles_coincide(85.0 * kRadPerDeg, 95.0 * kRadPerDeg));
}

TEST(SpinGeometry, AChordAtItsWidestIsPredictedFromItsThreeSides) {
  // With the Earth on the beam's cone, the half chord c satisfies sin(rho / 2) = sin(g) sin(c / 2),
  // from an isosceles triangle.
  const double mount_rad = 70.0 * kRadPerDeg;
  const double disc_rad = 20.0 * kRadPerDeg;
  const double half_rad = 2.0 * std::asin(std::sin(0.5 * disc_rad) / std::sin(mount_rad));
  EXPECT_NEAR(predict_chord_rad(mount_rad, mount_rad, disc_rad).value(), 2.0 * half_rad, kRounding);
}

TEST(SpinGeometry, ABeamThatMissesTheDiscOrNeverLeavesItHasNoChord) {
  EXPECT_TRUE(predict_chord_rad(85.0 * kRadPerDeg, 75.1 * kRadPerDeg, 10.0 * kRadPerDeg));
  EXPECT_FALSE(predict_chord_rad(85.0 * kRadPerDeg, 74.9 * kRadPerDeg, 10.0 * kRadPerDeg));
  EXPECT_FALSE(predict_chord_rad(5.0 * kRadPerDeg, 2.0 * kRadPerDeg, 10.0 * kRadPerDeg));
}

/// Returns the roots of the chord equation.
std::vector<double> earth_angles(double mount_rad, double chord_rad, double disc_rad) {
  return cone_roots(std::cos(mount_rad), std::sin(mount_rad) * std::cos(0.5 * chord_rad),
                    std::cos(disc_rad))
      .angles_rad;
}

TEST(SpinGeometry, BothRootsOfTheChordEquationGiveTheChordThatWasMeasured) {
  const double mount_rad = 85.0 * kRadPerDeg;
  const double disc_rad = 25.0 * kRadPerDeg;
  const double chord_rad = predict_chord_rad(mount_rad, 1.6, disc_rad).value();
  const auto roots = earth_angles(mount_rad, chord_rad, disc_rad);
  ASSERT_EQ(roots.size(), 2U);
  EXPECT_GT(std::abs(roots[0] - roots[1]), 1.0 * kRadPerDeg);
  for (const double root : roots) {
    EXPECT_NEAR(predict_chord_rad(mount_rad, root, disc_rad).value(), chord_rad, 100.0 * kRounding);
  }
}

TEST(SpinGeometry, ARootOutsideTheSphereIsNoRoot) {
  // With the beam 5 deg from the axis and a disc of radius 8 deg, the smaller root is negative.
  const double mount_rad = 5.0 * kRadPerDeg;
  const double disc_rad = 8.0 * kRadPerDeg;
  const double chord_rad = predict_chord_rad(mount_rad, 8.0 * kRadPerDeg, disc_rad).value();
  const auto roots = earth_angles(mount_rad, chord_rad, disc_rad);
  EXPECT_THAT(roots, ElementsAre(::testing::DoubleNear(8.0 * kRadPerDeg, 100.0 * kRounding)));
}

TEST(SpinGeometry, ARootOutsideSolvesTheEquationToo) {
  for (const double a : {-0.9, -0.3, 0.4, 0.95}) {
    for (const double b : {-0.8, -0.1, 0.2, 0.7}) {
      for (const double c : {-0.2, 0.1}) {
        const auto roots = cone_roots(a, b, c);
        ASSERT_EQ(roots.angles_rad.size() + roots.outside_rad.size(), 2U);
        for (const double root : roots.outside_rad) {
          EXPECT_NEAR(a * std::cos(root) + b * std::sin(root), c, 10.0 * kRounding);
          EXPECT_LE(std::sin(root), kRounding);
        }
      }
    }
  }
}

TEST(SpinGeometry, AChordWiderThanTheDiscHasNoRootAndSaysByHowMuch) {
  const auto roots = cone_roots(std::cos(1.4), std::sin(1.4) * std::cos(0.4), std::cos(0.2));
  EXPECT_TRUE(roots.angles_rad.empty());
  EXPECT_NEAR(roots.excess,
              std::cos(0.2) / std::hypot(std::cos(1.4), std::sin(1.4) * std::cos(0.4)) - 1.0,
              kRounding);
  EXPECT_GT(roots.excess, 0.0);
}

TEST(SpinGeometry, DeterminantVanishesWhereBothEquationsAreTheSame) {
  // The Sun is on the equator, a quarter turn from the Earth.
  const OneChordInput<double> input{
      .chord = {.mount_angle_rad = 85.0 * kRadPerDeg, .chord_rad = 0.5},
      .sun_angle_rad = kPi / 2.0,
      .dihedral_rad = kPi / 2.0,
      .sun_earth_rad = kPi / 2.0,
      .disc_rad = 0.4};
  EXPECT_NEAR(determinant(input), 0.0, kRounding);
}

TEST(SpinGeometry, DeterminantIsThatOfTheTwoLinearEquations) {
  const OneChordInput<double> input{.chord = {.mount_angle_rad = 1.3, .chord_rad = 0.5},
                                    .sun_angle_rad = 1.1,
                                    .dihedral_rad = 0.6,
                                    .sun_earth_rad = 0.9,
                                    .disc_rad = 0.4};
  Eigen::Matrix2d equations;
  equations << std::cos(1.3), std::sin(1.3) * std::cos(0.25),  //
      std::cos(1.1), std::sin(1.1) * std::cos(0.6);
  EXPECT_NEAR(determinant(input), equations.determinant(), kRounding);
}

/// Holds a random scene in which the body sees Sun and Earth, and its observed revolution.
struct Scene {
  SpinConfig config = usual_config();
  double rate_rad_s = 2.0 * kPi / 6.0;
  Eigen::Vector3d sun_icrf;
  Eigen::Vector3d earth_icrf;
  Eigen::Vector3d axis_icrf;
  double disc_rad;
  Revolution seen;
};

Scene random_scene(std::mt19937_64& rng) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  const auto direction = [&] { return random_direction(normal, rng); };
  Scene scene;
  scene.sun_icrf = direction();
  scene.axis_icrf = direction();
  scene.disc_rad = (15.0 + 30.0 * uniform(rng)) * kRadPerDeg;
  const double earth_angle_rad = (80.0 + 20.0 * uniform(rng)) * kRadPerDeg;
  const Eigen::Vector3d across = scene.axis_icrf.cross(direction()).normalized();
  scene.earth_icrf = Eigen::AngleAxisd{earth_angle_rad, across} * scene.axis_icrf;
  const double range_km = 6418.137 / std::sin(scene.disc_rad);
  scene.seen = revolution_seen({.axis_icrf = scene.axis_icrf,
                                .rate_rad_s = scene.rate_rad_s,
                                .first_turn_rad = 2.0 * kPi * uniform(rng),
                                .config = scene.config},
                               at_rest(scene.sun_icrf, range_km * scene.earth_icrf),
                               tai_from_ns(1'795'143'637'000'000'000));
  return scene;
}

double between(const Scene& scene, PulseChannel from, PulseChannel to) {
  return scene.rate_rad_s *
         seconds_between(scene.seen.edge(from).value(), scene.seen.edge(to).value());
}

constexpr int kScenes = 200;
// Two edges, each rounded to 0.5 ns, at a turn in six seconds.
constexpr double kNanosecond_rad = 2.0 * kPi / 6.0 * 1e-9;

/// Checks many scenes.
/// @param check Returns whether the scene could be compared.
/// @return Number of scenes compared.
int for_scenes(unsigned seed, const std::function<bool(const Scene&)>& check) {
  std::mt19937_64 rng{seed};
  int compared = 0;
  for (int trial = 0; trial < kScenes && !::testing::Test::HasFailure(); ++trial) {
    SCOPED_TRACE(trial);
    compared += check(random_scene(rng)) ? 1 : 0;
  }
  return compared;
}

using enum PulseChannel;

TEST(SpinGeometry, PredictedChordsAreThoseOfTheOracle) {
  for_scenes(41, [](const Scene& scene) {
    const double earth_angle_rad = angle_between_rad(scene.axis_icrf, scene.earth_icrf);
    const auto north_rad =
        predict_chord_rad(scene.config.north->mount_angle_rad, earth_angle_rad, scene.disc_rad);
    EXPECT_EQ(north_rad.has_value(), scene.seen.edge(NorthIn).has_value());
    if (north_rad) {
      EXPECT_NEAR(*north_rad, between(scene, NorthIn, NorthOut), kNanosecond_rad);
    }
    return true;
  });
}

TEST(SpinGeometry, EarthAngleOfTwoChordsIsThatOfTheOracle) {
  const int compared = for_scenes(42, [](const Scene& scene) {
    if (!scene.seen.edge(NorthOut) || !scene.seen.edge(SouthOut)) {
      return false;
    }
    const double angle_rad =
        earth_angle_from_two_chords(Chord{.mount_angle_rad = scene.config.north->mount_angle_rad,
                                          .chord_rad = between(scene, NorthIn, NorthOut)},
                                    Chord{.mount_angle_rad = scene.config.south->mount_angle_rad,
                                          .chord_rad = between(scene, SouthIn, SouthOut)});
    // d(theta_e) / d(chord) <= sin(g) / 2 / |cos gN - cos gS| = 2.9 for each chord.
    EXPECT_NEAR(angle_rad, angle_between_rad(scene.axis_icrf, scene.earth_icrf),
                2.0 * 2.9 * kNanosecond_rad);
    return true;
  });
  EXPECT_GT(compared, kScenes / 2);
}

TEST(SpinGeometry, EarthAngleOfOneChordIsThatOfTheOracle) {
  const int linear = for_scenes(43, [](const Scene& scene) {
    if (!scene.seen.edge(NorthOut)) {
      return false;
    }
    const PredictedAngles angles =
        predict_angles(scene.axis_icrf, scene.sun_icrf, scene.earth_icrf);
    const OneChordInput<double> input{
        .chord = {.mount_angle_rad = scene.config.north->mount_angle_rad,
                  .chord_rad = between(scene, NorthIn, NorthOut)},
        .sun_angle_rad = angles.sun_angle_rad,
        .dihedral_rad = angles.dihedral_rad,
        .sun_earth_rad = angle_between_rad(scene.sun_icrf, scene.earth_icrf),
        .disc_rad = scene.disc_rad};
    if (std::abs(determinant(input)) < 0.03) {
      return false;
    }
    // At most half the chord's error, divided by the determinant.
    EXPECT_NEAR(earth_angle_linear(input), angles.earth_angle_rad, kNanosecond_rad / 0.03);
    return true;
  });
  EXPECT_GT(linear, kScenes / 2);
}

}  // namespace spindrift::testing::geometry_test
