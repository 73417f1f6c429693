#include "pipelines/spin/axis_candidates.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "pipelines/frames/celestial.h"
#include "pipelines/spin/geometry.h"
#include "tests/support/lone_fix.h"
#include "tests/support/spinning_body.h"

namespace spindrift {
namespace {

using enum SpinQuantity;

constexpr double kPi = std::numbers::pi;
constexpr double kDegree_rad = kPi / 180.0;
const TaiTime kStart = tai_from_ns(1'795'143'637'000'000'000);
constexpr double kRange_km = 16000.0;

/// A body about `axis_icrf` between Sun and Earth, one turn in six seconds: a nanosecond is 1e-9
/// rad of spin phase.
struct Scene {
  Eigen::Vector3d sun_icrf = Eigen::Vector3d{1.0, 0.2, 0.1}.normalized();
  Eigen::Vector3d earth_icrf = Eigen::Vector3d{0.3, 1.0, -0.02}.normalized();
  Eigen::Vector3d axis_icrf = Eigen::Vector3d{0.1, -0.05, 1.0}.normalized();
  double rate_rad_s = 2.0 * kPi / 6.0;
  SpinConfig config = testing::usual_config();

  Sightlines sightlines() const {
    return {.sun_icrf = sun_icrf,
            .earth_icrf = earth_icrf,
            .disc_rad = std::asin(6418.137 / kRange_km),
            .earth_pole_icrf = Eigen::Vector3d::UnitZ()};
  }
  Revolution seen() const {
    return testing::revolution_seen(
        {.axis_icrf = axis_icrf, .rate_rad_s = rate_rad_s, .first_turn_rad = 0.1, .config = config},
        testing::at_rest(sun_icrf, kRange_km * earth_icrf), kStart);
  }
  Expected<SpinFix> fix(const std::set<SpinQuantity>& left_out = {}) const {
    return testing::lone_fix(config, seen(), left_out, sightlines());
  }
};

// A nanosecond of an edge, amplified by the geometry at hand (5.7 for the earth angle of two beams
// 10 deg apart, 33 for one beam with |Delta| = 0.03).
constexpr double kExact_rad = 1e-7;

TEST(AxisCandidates, CaseOneHasBothChords) {
  const Scene scene;
  const SpinFix fix = scene.fix().value();
  EXPECT_EQ(fix.geometry_case, 1);
  EXPECT_EQ(fix.resolution, Resolution::Geometry);
  EXPECT_TRUE(fix.accepted);
  EXPECT_TRUE(fix.alternate_axes_icrf.empty());
  EXPECT_LT(angle_between_rad(fix.axis_icrf, scene.axis_icrf), kExact_rad);
  EXPECT_NEAR(fix.norm, 1.0, kExact_rad);
  EXPECT_EQ(fix.t, scene.seen().edge(PulseChannel::Sun1));
}

TEST(AxisCandidates, CasesTwoAndThreeHaveOneChord) {
  const Scene scene;
  for (const auto& [left_out, geometry_case] :
       {std::pair{SouthChord, 2}, std::pair{NorthChord, 3}}) {
    const SpinFix fix = scene.fix({left_out}).value();
    EXPECT_EQ(fix.geometry_case, geometry_case);
    EXPECT_EQ(fix.resolution, Resolution::Geometry);
    EXPECT_TRUE(fix.accepted);
    EXPECT_LT(angle_between_rad(fix.axis_icrf, scene.axis_icrf), kExact_rad);
  }
}

TEST(AxisCandidates, OneDihedralIsEnough) {
  const Scene scene;
  for (const SpinQuantity left_out : {NorthDihedral, SouthDihedral}) {
    const SpinFix fix = scene.fix({left_out}).value();
    EXPECT_EQ(fix.geometry_case, 1);
    EXPECT_LT(angle_between_rad(fix.axis_icrf, scene.axis_icrf), kExact_rad);
  }
}

TEST(AxisCandidates, ASensorThatTheMissionDoesNotHaveMakesItCaseTwo) {
  Scene scene;
  scene.config.south.reset();
  EXPECT_EQ(scene.fix().value().geometry_case, 2);
}

TEST(AxisCandidates, DihedralsOnEitherSideOfPiAreAveragedThere) {
  // The Earth opposite the Sun about the axis; the dihedrals of both beams stand about pi.
  const Scene scene{.sun_icrf = Eigen::Vector3d{1.0, 0.0, 0.3}.normalized(),
                    .earth_icrf = Eigen::Vector3d::UnitX() * -1.0,
                    .axis_icrf = Eigen::Vector3d::UnitZ()};
  Revolution revolution = scene.seen();
  for (const PulseChannel channel : {PulseChannel::NorthIn, PulseChannel::NorthOut}) {
    revolution.edges.at(index_of(channel)) = shifted(*revolution.edge(channel), 1e-4);
  }
  for (const PulseChannel channel : {PulseChannel::SouthIn, PulseChannel::SouthOut}) {
    revolution.edges.at(index_of(channel)) = shifted(*revolution.edge(channel), -1e-4);
  }
  const SpinFix fix = testing::lone_fix(scene.config, revolution, {}, scene.sightlines()).value();
  EXPECT_LT(angle_between_rad(fix.axis_icrf, scene.axis_icrf), kExact_rad);
}

TEST(AxisCandidates, SunAndEarthInLineLeaveTheAxisOpen) {
  const Eigen::Vector3d sun = Eigen::Vector3d{1.0, 0.2, 0.1}.normalized();
  const Eigen::Vector3d across = sun.unitOrthogonal();
  for (const double apart_deg : {0.0, 2.9, 177.1, 180.0}) {
    Scene scene{.sun_icrf = sun};
    scene.earth_icrf = Eigen::AngleAxisd{apart_deg * kDegree_rad, across} * sun;
    RevolutionMeasurements measured = measure(scene.config, Scene{}.seen());
    const auto solution = axis_candidates(scene.config, measured, scene.sightlines());
    ASSERT_FALSE(solution) << apart_deg;
    EXPECT_EQ(solution.error().code, ErrorCode::Unobservable);
    EXPECT_NE(solution.error().message.find("3 and 177 deg"), std::string::npos);
  }
}

TEST(AxisCandidates, BeamsMountedAlikeAreOneBeam) {
  Scene scene;
  for (const double apart_deg : {0.0, 0.3}) {
    scene.config.south->mount_angle_rad =
        scene.config.north->mount_angle_rad + apart_deg * kDegree_rad;
    const SpinFix fix = scene.fix().value();
    EXPECT_EQ(fix.geometry_case, 2);
    EXPECT_TRUE(fix.accepted);
    EXPECT_LT(angle_between_rad(fix.axis_icrf, scene.axis_icrf), kExact_rad);
  }
}

TEST(AxisCandidates, AWrongAzimuthContradictsTheAngleBetweenSunAndEarth) {
  const Scene scene;
  SpinConfig wrong = scene.config;
  wrong.north->azimuth_rad -= 80.0 * kDegree_rad;
  wrong.south->azimuth_rad -= 80.0 * kDegree_rad;
  const SpinFix fix = testing::lone_fix(wrong, scene.seen(), {}, scene.sightlines()).value();
  EXPECT_FALSE(fix.accepted);
  EXPECT_GT(std::abs(fix.norm - 1.0), 0.1);
}

TEST(AxisCandidates, ChordsOfAnotherDiscContradictTheOrbit) {
  const Scene scene;
  for (const double range_factor : {0.8, 1.25}) {
    Sightlines sightlines = scene.sightlines();
    sightlines.disc_rad = std::asin(std::sin(sightlines.disc_rad) / range_factor);
    const SpinFix fix = testing::lone_fix(scene.config, scene.seen(), {}, sightlines).value();
    EXPECT_FALSE(fix.accepted) << range_factor;
    // Two chords need no disc: the axis itself is right, and still nothing to rely on.
    EXPECT_LT(angle_between_rad(fix.axis_icrf, scene.axis_icrf), kExact_rad);
  }
}

/// The Sun on the body's equator and the Earth, some degrees from the axis, behind it by a dihedral
/// whose cosine is `determinant` / cos(85 deg): then Delta is `determinant`.
Scene scene_of_determinant(double determinant, double earth_angle_deg = 87.0) {
  const double dihedral_rad = std::acos(determinant / std::cos(85.0 * kDegree_rad));
  const double earth_angle_rad = earth_angle_deg * kDegree_rad;
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
    EXPECT_TRUE(fix.alternate_axes_icrf.empty()) << delta;
    EXPECT_EQ(fix.resolution, Resolution::Geometry);
    EXPECT_LT(angle_between_rad(fix.axis_icrf, scene.axis_icrf), kExact_rad);
  }
}

TEST(AxisCandidates, ASmallDeterminantLeavesTheOtherRootAsAlternate) {
  for (const double delta : {0.0298, -0.02, -0.0298}) {
    // The roots lie 15 deg on either side of the beam: noise and model move them by little.
    const Scene scene = scene_of_determinant(delta, 70.0);
    const SpinFix fix = scene.fix().value();
    EXPECT_EQ(fix.resolution, Resolution::Geometry) << delta;
    EXPECT_TRUE(fix.accepted);
    EXPECT_LT(angle_between_rad(fix.axis_icrf, scene.axis_icrf), kExact_rad);
    ASSERT_EQ(fix.alternate_axes_icrf.size(), 1);
    EXPECT_GT(angle_between_rad(fix.alternate_axes_icrf.front(), scene.axis_icrf), kDegree_rad);
  }
}

TEST(AxisCandidates, RootsThatTheModelMayExchangeAreAmbiguous) {
  // Two degrees on either side of the beam, where a limb 0.15 deg off moves them by as much.
  for (const double delta : {0.0298, 0.02, -0.02, -0.0298}) {
    const SpinFix fix = scene_of_determinant(delta).fix().value();
    EXPECT_EQ(fix.resolution, Resolution::Ambiguous) << delta;
    EXPECT_EQ(fix.alternate_axes_icrf.size(), 1);
  }
}

TEST(AxisCandidates, AVanishingDeterminantIsAmbiguousAndNotAccepted) {
  for (const double delta : {0.0098, 0.0, -0.0098}) {
    const Scene scene = scene_of_determinant(delta);
    const SpinFix fix = scene.fix().value();
    EXPECT_EQ(fix.resolution, Resolution::Ambiguous) << delta;
    EXPECT_FALSE(fix.accepted);
    EXPECT_EQ(fix.geometry_case, 2);
    ASSERT_EQ(fix.alternate_axes_icrf.size(), 1);
    const double off_rad = angle_between_rad(fix.axis_icrf, scene.axis_icrf);
    const double alternate_off_rad =
        angle_between_rad(fix.alternate_axes_icrf.front(), scene.axis_icrf);
    EXPECT_LT(std::min(off_rad, alternate_off_rad), kExact_rad);
    EXPECT_GT(std::max(off_rad, alternate_off_rad), kDegree_rad);
  }
}

/// The revolution with noise on every edge.
Revolution noisy(const Scene& scene, Revolution revolution, std::mt19937_64& rng) {
  std::normal_distribution<double> normal;
  for (std::size_t channel = 0; channel < kPulseChannels; ++channel) {
    const bool sun = channel < index_of(PulseChannel::NorthIn);
    const double sigma_s = sun ? scene.config.noise.sun_s : scene.config.noise.infrared_s;
    if (auto& edge = revolution.edges.at(channel)) {
      edge = shifted(*edge, sigma_s * normal(rng));
    }
  }
  return revolution;
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
          testing::lone_fix(scene.config, noisy(scene, exact, rng), {}, scene.sightlines());
      if (fix && fix->accepted) {
        const double sigma_rad = std::sqrt(fix->covariance_rad2.trace());
        EXPECT_LT(angle_between_rad(fix->axis_icrf, scene.axis_icrf), 6.0 * sigma_rad) << delta;
      }
    }
  }
}

TEST(AxisCandidates, LimitsOfTheDeterminantAreThoseOfTheMission) {
  Scene scene = scene_of_determinant(0.05);
  scene.config.geometry = {.determinant_usable = 0.08, .determinant_ambiguous = 0.06};
  EXPECT_EQ(scene.fix().value().resolution, Resolution::Ambiguous);
  scene.config.geometry = {.determinant_usable = 0.08, .determinant_ambiguous = 0.04};
  EXPECT_FALSE(scene.fix().value().alternate_axes_icrf.empty());
  scene.config.geometry = {.determinant_usable = 0.04, .determinant_ambiguous = 0.01};
  EXPECT_TRUE(scene.fix().value().alternate_axes_icrf.empty());
}

TEST(AxisCandidates, AChordWiderThanTheDiscIsRefusedWithItsMeasure) {
  Scene scene = scene_of_determinant(0.02);
  Revolution revolution = scene.seen();
  const TaiTime in = revolution.edge(PulseChannel::NorthIn).value();
  revolution.edges.at(index_of(PulseChannel::NorthOut)) = shifted(in, 0.9 / scene.rate_rad_s);
  const auto fix = testing::lone_fix(scene.config, revolution, {}, scene.sightlines());
  ASSERT_FALSE(fix);
  EXPECT_EQ(fix.error().code, ErrorCode::InvalidInput);
  EXPECT_NE(fix.error().message.find("chord 51.5662 deg"), std::string::npos)
      << fix.error().message;
}

/// Sum over noisy copies of the revolution of the squared error, normalised by the covariance that
/// the undisturbed revolution states.
double squared_errors(const Scene& scene, const std::set<SpinQuantity>& left_out, int draws,
                      std::mt19937_64& rng) {
  const Revolution exact = scene.seen();
  const SpinFix stated =
      testing::lone_fix(scene.config, exact, left_out, scene.sightlines()).value();
  const Eigen::Matrix<double, 3, 2> basis = tangent_basis(stated.axis_icrf);
  std::normal_distribution<double> normal;
  double sum = 0.0;
  for (int draw = 0; draw < draws; ++draw) {
    Revolution noisy = exact;
    for (std::size_t channel = 0; channel < kPulseChannels; ++channel) {
      const bool sun = channel < index_of(PulseChannel::NorthIn);
      const double sigma_s = sun ? scene.config.noise.sun_s : scene.config.noise.infrared_s;
      noisy.edges.at(channel) = shifted(exact.edges.at(channel).value(), sigma_s * normal(rng));
    }
    const auto fix = testing::lone_fix(scene.config, noisy, left_out, scene.sightlines());
    const Eigen::Vector2d error_rad = basis.transpose() * fix.value().axis_icrf;
    sum += error_rad.dot(stated.covariance_rad2.ldlt().solve(error_rad));
  }
  return sum;
}

TEST(AxisCandidates, CovarianceIsTheScatterThatTheNoiseMakes) {
  constexpr int kDraws = 3000;
  std::mt19937_64 rng{91};
  // Noise small enough that the geometry is linear within it: 1e-4 rad of spin phase at most.
  Scene scene;
  scene.config.noise = {.sun_s = 2e-5, .infrared_s = 1e-4};
  // 99.9 % of chi-square with 6000 degrees of freedom, standard deviation sqrt(12000).
  constexpr double kSpread = 3.29 * 109.5;
  for (const std::set<SpinQuantity>& left_out :
       {std::set<SpinQuantity>{}, std::set{SouthChord}, std::set{NorthChord},
        std::set{NorthDihedral}, std::set{SouthChord, NorthDihedral}}) {
    SCOPED_TRACE(left_out.size());
    EXPECT_NEAR(squared_errors(scene, left_out, kDraws, rng), 2.0 * kDraws, kSpread);
  }
}

TEST(AxisCandidates, CovarianceGrowsWithTheSquareOfTheNoise) {
  Scene scene;
  scene.config.noise = {.sun_s = 1e-5, .infrared_s = 5e-5};
  const Eigen::Matrix2d once = scene.fix().value().covariance_rad2;
  scene.config.noise = {.sun_s = 2e-5, .infrared_s = 1e-4};
  const Eigen::Matrix2d twice = scene.fix().value().covariance_rad2;
  // Edges move by whole nanoseconds: 5e-5 of the lesser noise.
  EXPECT_LT((twice - 4.0 * once).norm(), 4e-4 * twice.norm());
}

TEST(AxisCandidates, ASolutionThatTheNoiseDestroysIsRefused) {
  // At its widest the chord has a double root, which every edge moves without bound.
  Scene scene = scene_of_determinant(0.02);
  scene.earth_icrf = direction_icrf(
      {.ra_rad = std::acos(0.02 / std::cos(85.0 * kDegree_rad)), .dec_rad = 5.0 * kDegree_rad});
  scene.config.noise.infrared_s = 5e-2;
  const auto fix = scene.fix();
  ASSERT_FALSE(fix);
  EXPECT_EQ(fix.error().code, ErrorCode::Unobservable);
}

/// Measurements as if of an axis, without noise.
RevolutionMeasurements measured_at(const SpinConfig& config, const PredictedAngles& angles,
                                   double disc_rad) {
  const auto exact = [](double value_rad) {
    return Measured{.value_rad = value_rad, .sigma_rad = 0.0, .noise_rad = EdgeNoise::Zero()};
  };
  RevolutionMeasurements measured{.t_sun1 = kStart,
                                  .sun_angle = exact(angles.sun_angle_rad),
                                  .mixed_azimuth = {},
                                  .crossings = {},
                                  .silent = {}};
  for (const Side side : kSides) {
    measured.crossings.at(index_of(side)) =
        EarthCrossing{.t_mid = kStart,
                      .chord = exact(predict_chord_rad(sensor_of(config, side)->mount_angle_rad,
                                                       angles.earth_angle_rad, disc_rad)
                                         .value()),
                      .dihedral = {}};
  }
  return measured;
}

TEST(AxisCandidates, TwoConesMeetInTheTrueAndTheFalseSolutionOfTheGoldenValues) {
  // Worked out in 30 digits by mpmath, printed to 1e-9 deg.
  const auto at_deg = [](double ra_deg, double dec_deg) {
    return direction_icrf({.ra_rad = ra_deg * kDegree_rad, .dec_rad = dec_deg * kDegree_rad});
  };
  SpinConfig config = testing::usual_config();
  config.north->mount_angle_rad = 120.0 * kDegree_rad;
  config.south->mount_angle_rad = 145.0 * kDegree_rad;
  const Sightlines sightlines{.sun_icrf = at_deg(10.0, 4.3),
                              .earth_icrf = at_deg(80.0, -20.0),
                              .disc_rad = 20.0 * kDegree_rad,
                              .earth_pole_icrf = Eigen::Vector3d::UnitZ()};
  const PredictedAngles angles{.sun_angle_rad = 90.143759304 * kDegree_rad,
                               .earth_angle_rad = 131.253314001 * kDegree_rad,
                               .dihedral_rad = 67.046435278 * kDegree_rad};
  const auto found =
      axis_candidates(config, measured_at(config, angles, sightlines.disc_rad), sightlines).value();
  EXPECT_EQ(found.geometry_case, 1);
  EXPECT_FALSE(found.told_apart);
  ASSERT_EQ(found.candidates.size(), 2U);
  constexpr double kPrinted_rad = 4e-9 * kDegree_rad;
  EXPECT_LT(angle_between_rad(found.candidates[0].axis_icrf, at_deg(268.625, 68.4485)),
            kPrinted_rad);
  EXPECT_LT(angle_between_rad(found.candidates[1].axis_icrf, at_deg(281.751608418, -23.899303556)),
            kPrinted_rad);
}

/// What is missing, and the case that it leaves.
struct Loss {
  std::set<PulseChannel> edges;
  std::set<SpinQuantity> quantities;
  int geometry_case;
};

const std::vector<Loss>& losses() {
  using enum PulseChannel;
  static const std::vector<Loss> all = {
      {{}, {}, 1},
      {{SouthIn}, {}, 2},
      {{NorthOut}, {}, 3},
      {{}, {NorthDihedral, SouthDihedral}, 1},
      {{SouthIn}, {NorthDihedral}, 2},
      {{NorthIn}, {SouthDihedral}, 3},
      {{Sun2}, {}, 4},
      {{Sun2, SouthIn}, {}, 5},
      {{Sun2, NorthIn}, {}, 6},
      {{Sun1}, {}, 7},
      {{Sun1, SouthOut}, {}, 5},
      {{Sun1, NorthOut}, {}, 6},
  };
  return all;
}

Revolution without(Revolution revolution, const std::set<PulseChannel>& edges) {
  for (const PulseChannel channel : edges) {
    revolution.edges.at(index_of(channel)).reset();
  }
  return revolution;
}

/// A body anywhere, Sun and Earth where its sensors see them.
Scene random_scene(std::mt19937_64& rng) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform{-1.0, 1.0};
  const auto direction = [&]() -> Eigen::Vector3d {
    const double x = normal(rng);
    const double y = normal(rng);
    return Eigen::Vector3d{x, y, normal(rng)}.normalized();
  };
  Scene scene;
  scene.axis_icrf = direction();
  const auto away = [&](double angle_deg) -> Eigen::Vector3d {
    return Eigen::AngleAxisd{angle_deg * kDegree_rad,
                             scene.axis_icrf.cross(direction()).normalized()} *
           scene.axis_icrf;
  };
  scene.sun_icrf = away(90.0 + 35.0 * uniform(rng));
  scene.earth_icrf = away(90.0 + 10.0 * uniform(rng));
  // Small: what comes of it is linear, and stays above the nanosecond.
  scene.config.noise = {.sun_s = 2e-6, .infrared_s = 2e-6};
  return scene;
}

TEST(AxisCandidates, EveryCaseHasTheTrueAxisAmongItsCandidates) {
  constexpr int kScenes = 200;
  for (const Loss& loss : losses()) {
    std::mt19937_64 rng{92};
    int found_true = 0;
    for (int trial = 0; trial < kScenes; ++trial) {
      SCOPED_TRACE(loss.geometry_case * 1000 + trial);
      const Scene scene = random_scene(rng);
      const RevolutionMeasurements measured = testing::measured_without(
          scene.config, without(scene.seen(), loss.edges), loss.quantities);
      ASSERT_EQ(geometry_case_of(measured), loss.geometry_case);
      const auto found = axis_candidates(scene.config, measured, scene.sightlines());
      if (!found) {
        ASSERT_EQ(found.error().code, ErrorCode::Unobservable);
        continue;
      }
      ASSERT_LE(found->candidates.size(), 4U);
      ASSERT_EQ(found->geometry_case, loss.geometry_case);
      const auto nearest =
          std::min_element(found->candidates.begin(), found->candidates.end(),
                           [&](const AxisCandidate& a, const AxisCandidate& b) {
                             return angle_between_rad(a.axis_icrf, scene.axis_icrf) <
                                    angle_between_rad(b.axis_icrf, scene.axis_icrf);
                           });
      const double off_rad = angle_between_rad(nearest->axis_icrf, scene.axis_icrf);
      if (found->grazing) {
        // Only what is left over of cases 2 and 3 tells such roots apart.
        ASSERT_TRUE(!found->told_apart || loss.quantities.empty());
        ASSERT_TRUE(!found->told_apart || loss.geometry_case < 4);
        // A double root takes the square root of a nanosecond.
        found_true += off_rad < 1e-3 ? 1 : 0;
        continue;
      }
      ASSERT_LT(off_rad, 1e-5);
      ASSERT_TRUE(nearest->consistent);
      ASSERT_TRUE(!found->told_apart || nearest == found->candidates.begin());
      ++found_true;
    }
    EXPECT_GT(found_true, kScenes / 2) << loss.geometry_case;
  }
}

TEST(AxisCandidates, CovariancesAreThoseOfCentralDifferencesInEveryCase) {
  for (const Loss& loss : losses()) {
    std::mt19937_64 rng{93};
    int compared = 0;
    for (int trial = 0; trial < 60; ++trial) {
      SCOPED_TRACE(loss.geometry_case * 1000 + trial);
      const Scene scene = random_scene(rng);
      const Revolution revolution = without(scene.seen(), loss.edges);
      const auto solve = [&](const Revolution& seen) {
        return axis_candidates(scene.config,
                               testing::measured_without(scene.config, seen, loss.quantities),
                               scene.sightlines());
      };
      const auto found = solve(revolution);
      if (!found || found->grazing) {
        continue;
      }
      constexpr double kStep_s = 2e-6;
      for (std::size_t i = 0; i < found->candidates.size(); ++i) {
        const AxisCandidate& candidate = found->candidates[i];
        // Where the geometry multiplies errors a hundredfold, differences are no measure.
        if (candidate.covariance_rad2.trace() > std::pow(2e-4, 2)) {
          continue;
        }
        const Eigen::Matrix<double, 3, 2> basis = tangent_basis(candidate.axis_icrf);
        Eigen::Matrix2d expected = Eigen::Matrix2d::Zero();
        for (std::size_t channel = 0; channel < kPulseChannels; ++channel) {
          if (!revolution.edges.at(channel)) {
            continue;
          }
          Revolution later = revolution;
          Revolution earlier = revolution;
          later.edges.at(channel) = shifted(*revolution.edges.at(channel), kStep_s);
          earlier.edges.at(channel) = shifted(*revolution.edges.at(channel), -kStep_s);
          const Eigen::Vector2d moved = 0.5 * basis.transpose() *
                                        (solve(later)->candidates.at(i).axis_icrf -
                                         solve(earlier)->candidates.at(i).axis_icrf);
          expected += moved * moved.transpose();
        }
        // Of the step's square 1e-3 is lost where edges move by whole nanoseconds.
        ASSERT_LT((candidate.covariance_rad2 - expected).norm(), 3e-3 * expected.norm());
        ++compared;
      }
    }
    EXPECT_GT(compared, 30) << loss.geometry_case;
  }
}

TEST(AxisCandidates, OnlyWhatCouldGiveAFixCanContradictItself) {
  Scene scene;
  const auto contradicts = [&](const RevolutionMeasurements& measured) {
    return contradicts_itself(axis_candidates(scene.config, measured, scene.sightlines()));
  };
  EXPECT_FALSE(contradicts(measure(scene.config, scene.seen())));
  RevolutionMeasurements cones =
      testing::measured_without(scene.config, scene.seen(), {NorthDihedral, SouthDihedral});
  cones.sun_angle->value_rad = 10.0 * kDegree_rad;
  EXPECT_TRUE(contradicts(cones));
  const Revolution seen = scene.seen();
  EXPECT_FALSE(
      contradicts(testing::measured_without(scene.config, seen, {NorthChord, SouthChord})));
  scene.config.north->mount_angle_rad = 20.0 * kDegree_rad;
  scene.config.south->mount_angle_rad = 160.0 * kDegree_rad;
  EXPECT_TRUE(contradicts(measure(scene.config, seen)));
}

TEST(AxisCandidates, ConesAreNamedInWords) {
  using enum PulseChannel;
  const Scene scene;
  const std::vector<std::pair<Loss, std::string>> cones = {
      {{{Sun1, Sun2}, {}, 8}, "cone about the Earth only"},
      {{{NorthIn, SouthIn}, {}, 9}, "cone about the Sun only"},
      {{{Sun1, Sun2, NorthIn}, {}, 10}, "cones about the Earth only"},
      {{{Sun1, Sun2, SouthIn}, {}, 10}, "cones about the Earth only"},
      {{{Sun1, NorthIn, SouthIn}, {}, 0}, "no measurement"},
      {{{Sun1, Sun2, NorthIn, SouthIn}, {}, 0}, "no measurement"}};
  for (const auto& [loss, words] : cones) {
    const RevolutionMeasurements measured =
        measure(scene.config, without(scene.seen(), loss.edges));
    EXPECT_EQ(geometry_case_of(measured), loss.geometry_case);
    const auto found = axis_candidates(scene.config, measured, scene.sightlines());
    ASSERT_FALSE(found);
    EXPECT_EQ(found.error().code, ErrorCode::Unobservable);
    EXPECT_NE(found.error().message.find(words), std::string::npos) << found.error().message;
  }
}

TEST(AxisCandidates, ConesThatDoNotMeetAreRefused) {
  const Scene scene;
  RevolutionMeasurements measured =
      testing::measured_without(scene.config, scene.seen(), {NorthDihedral, SouthDihedral});
  measured.sun_angle->value_rad = 10.0 * kDegree_rad;
  const auto found = axis_candidates(scene.config, measured, scene.sightlines());
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().code, ErrorCode::InvalidInput);
  EXPECT_NE(found.error().message.find("do not meet"), std::string::npos);
}

TEST(AxisCandidates, WhatRestsOnARejectedEdgeIsNotUsed) {
  const Scene scene;
  Revolution revolution = scene.seen();
  revolution.edge_rejections.at(index_of(PulseChannel::SouthOut)) = Rejection::Phase;
  EXPECT_EQ(geometry_case_of(measure(scene.config, revolution)), 2);
  revolution.edge_rejections.at(index_of(PulseChannel::Sun2)) = Rejection::Phase;
  EXPECT_EQ(geometry_case_of(measure(scene.config, revolution)), 5);
}

}  // namespace
}  // namespace spindrift
