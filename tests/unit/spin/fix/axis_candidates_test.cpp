#include "pipelines/spin/fix/axis_candidates.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/spin/sensor_model/geometry.h"
#include "pipelines/spin/sensor_model/horizon.h"
#include "tests/support/axis_scene.h"
#include "tests/support/matchers.h"
#include "tests/support/misaligned.h"

namespace spindrift::testing::axis_candidates_test {

using Scene = AxisScene;
using enum SpinQuantity;

struct AxisCandidatesTest : ::testing::Test {
  Scene scene;
};

TEST_F(AxisCandidatesTest, CaseOneHasBothChords) {
  const SpinFix fix = scene.fix().value();
  EXPECT_EQ(fix.geometry_case, 1);
  EXPECT_EQ(fix.resolution, Resolution::Geometry);
  EXPECT_TRUE(fix.accepted);
  EXPECT_TRUE(fix.alternates.empty());
  EXPECT_LT(scene.off_rad(fix.axis_icrf), kExact_rad);
  EXPECT_NEAR(fix.norm, 1.0, kExact_rad);
  EXPECT_EQ(fix.t, scene.seen().edge(PulseChannel::Sun1));
}

TEST_F(AxisCandidatesTest, WhatIsLeftOutMakesTheCase) {
  for (const auto& [left_out, geometry_case] :
       {std::pair{SouthChord, 2}, std::pair{NorthChord, 3}, std::pair{NorthDihedral, 1},
        std::pair{SouthDihedral, 1}}) {
    SCOPED_TRACE(name_of(left_out));
    const SpinFix fix = scene.fix({left_out}).value();
    EXPECT_EQ(fix.geometry_case, geometry_case);
    EXPECT_EQ(fix.resolution, Resolution::Geometry);
    EXPECT_TRUE(fix.accepted);
    EXPECT_LT(scene.off_rad(fix.axis_icrf), kExact_rad);
  }
}

TEST_F(AxisCandidatesTest, AChordMayBeWiderThanHalfATurn) {
  scene.earth_icrf =
      Eigen::AngleAxisd{10.0 * kRadPerDeg, scene.axis_icrf.unitOrthogonal()} * scene.axis_icrf;
  scene.config.north->mount_angle_rad = 16.0 * kRadPerDeg;
  scene.config.south->mount_angle_rad = 20.0 * kRadPerDeg;
  const RevolutionMeasurements measured = scene.measured();
  EXPECT_GT(value_of(measured, NorthChord)->value_rad, 240.0 * kRadPerDeg);
  EXPECT_GT(value_of(measured, SouthChord)->value_rad, 190.0 * kRadPerDeg);
  for (const std::set<SpinQuantity>& left_out :
       {std::set<SpinQuantity>{}, std::set{SouthChord}, std::set{NorthChord}}) {
    const SpinFix fix = scene.fix(left_out).value();
    EXPECT_LT(scene.off_rad(fix.axis_icrf), kExact_rad) << left_out.size();
  }
}

TEST_F(AxisCandidatesTest, ASensorThatTheMissionDoesNotHaveOrThatSeesTheSameMakesItCaseTwo) {
  for (const double apart_deg : {0.0, 0.3}) {
    scene.config.south->mount_angle_rad =
        scene.config.north->mount_angle_rad + apart_deg * kRadPerDeg;
    const SpinFix fix = scene.fix().value();
    EXPECT_EQ(fix.geometry_case, 2);
    EXPECT_TRUE(fix.accepted);
    EXPECT_LT(scene.off_rad(fix.axis_icrf), kExact_rad);
  }
  scene.config.south.reset();
  EXPECT_EQ(scene.fix().value().geometry_case, 2);
}

TEST(AxisCandidates, DihedralsOnEitherSideOfPiAreAveragedThere) {
  // The Earth is opposite the Sun about the axis, so the dihedrals of both beams are near pi.
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
  const SpinFix fix = lone_fix(scene.config, revolution, {}, scene.sun_earth()).value();
  EXPECT_LT(scene.off_rad(fix.axis_icrf), kExact_rad);
}

TEST(AxisCandidates, AnEarthThatMovesBetweenTheEdgesIsAllowedFor) {
  const Scene scene;  // One turn takes six seconds, and the Earth moves at 0.03 deg/s.
  const Eigen::Vector3d motion_icrf_s{-5e-4, 1e-4, 2e-4};
  const Revolution seen = scene.seen_while_earth_moves(motion_icrf_s);
  const SunEarthDirections sun_earth = scene.sightlines_while_earth_moves(motion_icrf_s);
  for (const std::set<SpinQuantity>& left_out :
       {std::set<SpinQuantity>{}, std::set{SouthChord}, std::set{NorthChord}}) {
    const auto off_rad = [&](const SunEarthDirections& taken) {
      const SpinFix fix = lone_fix(scene.config, seen, left_out, taken).value();
      return scene.off_rad(fix.axis_icrf);
    };
    EXPECT_LT(off_rad(sun_earth), 0.02 * off_rad(scene.sun_earth()));
    EXPECT_GT(off_rad(scene.sun_earth()), 0.03 * kRadPerDeg);
  }
}

TEST(AxisCandidates, SunAndEarthInLineLeaveTheAxisOpen) {
  const Eigen::Vector3d sun = Eigen::Vector3d{1.0, 0.2, 0.1}.normalized();
  const Eigen::Vector3d across = sun.unitOrthogonal();
  for (const double apart_deg : {0.0, 2.9, 177.1, 180.0}) {
    Scene scene{.sun_icrf = sun};
    scene.earth_icrf = Eigen::AngleAxisd{apart_deg * kRadPerDeg, across} * sun;
    RevolutionMeasurements measured = measure(scene.config, Scene{}.seen());
    const auto solution = axis_candidates(scene.config, measured, scene.sun_earth());
    ASSERT_FALSE(solution) << apart_deg;
    EXPECT_FALSE(solution.error().contradictory);
    EXPECT_EQ(solution.error().why.code, NoFixCode::SunEarthInLine);
  }
}

TEST_F(AxisCandidatesTest, AWrongAzimuthContradictsTheAngleBetweenSunAndEarth) {
  SpinConfig wrong = scene.config;
  wrong.north->azimuth_rad -= 80.0 * kRadPerDeg;
  wrong.south->azimuth_rad -= 80.0 * kRadPerDeg;
  const SpinFix fix = lone_fix(wrong, scene.seen(), {}, scene.sun_earth()).value();
  EXPECT_FALSE(fix.accepted);
  EXPECT_GT(std::abs(fix.norm - 1.0), 0.1);
}

TEST_F(AxisCandidatesTest, ChordsOfAnotherDiscContradictTheOrbit) {
  for (const double range_factor : {0.8, 1.25}) {
    SunEarthDirections sun_earth = scene.sun_earth();
    sun_earth.disc_rad = std::asin(std::sin(sun_earth.disc_rad) / range_factor);
    const SpinFix fix = lone_fix(scene.config, scene.seen(), {}, sun_earth).value();
    EXPECT_FALSE(fix.accepted) << range_factor;
    // Two chords need no disc: the axis is right, but the fix must not be trusted.
    EXPECT_LT(scene.off_rad(fix.axis_icrf), kExact_rad);
  }
}

/// Returns the candidate nearest the true axis.
AxisCandidate true_candidate(const AxisScene& scene, const SpinConfig& config,
                             const std::set<SpinQuantity>& left_out,
                             const SunEarthDirections& sun_earth) {
  const auto found =
      axis_candidates(config, measured_without(config, scene.seen(), left_out), sun_earth).value();
  return *std::ranges::min_element(found.candidates, {}, [&](const AxisCandidate& candidate) {
    return scene.off_rad(candidate.axis_icrf);
  });
}

TEST_F(AxisCandidatesTest, AnErrorOfTheMissionFileMovesTheAxisByItsShift) {
  SpinAlignmentVector sigmas = SpinAlignmentVector::Constant(1e-5);
  sigmas[Co2AltitudeError] = 0.1;
  sigmas[TimeTagError] = 0.05;
  scene.config.alignment = sigmas.cwiseAbs2().asDiagonal();
  SunEarthDirections said = scene.sun_earth();
  said.t_earth = scene.start;
  said.earth_motion_icrf_s = Eigen::Vector3d{3e-4, -5e-5, 2e-4};
  for (const std::set<SpinQuantity>& left_out : std::vector<std::set<SpinQuantity>>{
           {}, {SouthChord, SouthDihedral}, {NorthDihedral, SouthDihedral}, {SunAngle}}) {
    const AxisCandidate candidate = true_candidate(scene, scene.config, left_out, said);
    for (int error = 0; error < kSpinAlignmentErrors; ++error) {
      SCOPED_TRACE(kSpinAlignmentKeys.at(static_cast<std::size_t>(error)));
      const SpinConfig corrected =
          true_config(scene.config, sigmas[error] * SpinAlignmentVector::Unit(error));
      SunEarthDirections sun_earth = said;
      if (error == Co2AltitudeError) {
        sun_earth.disc_rad =
            std::asin(std::sin(said.disc_rad) * horizon_axes(corrected.horizon).equatorial_km /
                      horizon_axes(scene.config.horizon).equatorial_km);
      } else if (error == TimeTagError) {
        sun_earth.earth_icrf =
            (said.earth_icrf - sigmas[error] * said.earth_motion_icrf_s).normalized();
        sun_earth.disc_rad +=
            std::tan(said.disc_rad) * sigmas[error] * said.earth_motion_icrf_s.dot(said.earth_icrf);
      }
      const Eigen::Vector3d moved =
          true_candidate(scene, corrected, left_out, sun_earth).axis_icrf - candidate.axis_icrf;
      const Eigen::Vector3d expected = candidate.alignment_shift_icrf.col(error);
      // A beam mounted otherwise sees another place of the moving Earth, which the shift leaves
      // out.
      EXPECT_LT((moved - expected).norm(), 0.06 * expected.norm() + 1e-7);
    }
    EXPECT_NEAR(candidate.alignment_rad2.trace(), candidate.alignment_shift_icrf.squaredNorm(),
                1e-9 * candidate.alignment_rad2.trace());
  }
}

TEST_F(AxisCandidatesTest, OnlyWhatCouldGiveAFixCanContradictItself) {
  const auto contradicts = [&](const RevolutionMeasurements& measured) {
    return is_inconsistent(axis_candidates(scene.config, measured, scene.sun_earth()));
  };
  EXPECT_FALSE(contradicts(scene.measured()));
  RevolutionMeasurements cones = scene.measured({NorthDihedral, SouthDihedral});
  cones.sun_angle->value_rad = 10.0 * kRadPerDeg;
  EXPECT_TRUE(contradicts(cones));
  const auto apart = axis_candidates(scene.config, cones, scene.sun_earth());
  ASSERT_FALSE(apart);
  EXPECT_EQ(apart.error().why.code, NoFixCode::ConesApart);
  const Revolution seen = scene.seen();
  EXPECT_FALSE(contradicts(scene.measured({NorthChord, SouthChord})));
  scene.config.north->mount_angle_rad = 20.0 * kRadPerDeg;
  scene.config.south->mount_angle_rad = 160.0 * kRadPerDeg;
  EXPECT_TRUE(contradicts(measure(scene.config, seen)));
}

TEST_F(AxisCandidatesTest, WhatRestsOnARejectedEdgeIsNotUsed) {
  Revolution revolution = scene.seen();
  revolution.edge_rejections.at(index_of(PulseChannel::SouthOut)) = Rejection::Phase;
  EXPECT_EQ(geometry_case_of(measure(scene.config, revolution)), 2);
  revolution.edge_rejections.at(index_of(PulseChannel::Sun2)) = Rejection::Phase;
  EXPECT_EQ(geometry_case_of(measure(scene.config, revolution)), 5);
}

/// Returns noise-free measurements for an axis with these angles.
RevolutionMeasurements measured_at(const SpinConfig& config, const PredictedAngles& angles,
                                   double disc_rad) {
  const auto exact = [](double value_rad) {
    return Measured{.value_rad = value_rad, .sigma_rad = 0.0, .noise_rad = EdgeNoise::Zero()};
  };
  RevolutionMeasurements measured{.noise = config.noise,
                                  .t_sun1 = Scene{}.start,
                                  .sun_angle = exact(angles.sun_angle_rad),
                                  .mixed_azimuth = {},
                                  .crossings = {},
                                  .silent = {}};
  for (const Side side : kSides) {
    measured.crossings.at(index_of(side)) =
        EarthCrossing{.t_in = Scene{}.start,
                      .t_out = Scene{}.start,
                      .chord = exact(predict_chord_rad(sensor_of(config, side)->mount_angle_rad,
                                                       angles.earth_angle_rad, disc_rad)
                                         .value()),
                      .dihedral = {}};
  }
  return measured;
}

TEST(AxisCandidates, TwoConesMeetInTheTrueAndTheFalseSolutionOfTheGoldenValues) {
  // Computed with 30 digits in mpmath, printed to 1e-9 deg.
  const auto at_deg = [](double ra_deg, double dec_deg) {
    return direction_icrf({.ra_rad = ra_deg * kRadPerDeg, .dec_rad = dec_deg * kRadPerDeg});
  };
  SpinConfig config = usual_config();
  config.north->mount_angle_rad = 120.0 * kRadPerDeg;
  config.south->mount_angle_rad = 145.0 * kRadPerDeg;
  const SunEarthDirections sun_earth{.sun_icrf = at_deg(10.0, 4.3),
                                     .earth_icrf = at_deg(80.0, -20.0),
                                     .disc_rad = 20.0 * kRadPerDeg,
                                     .earth_pole_icrf = Eigen::Vector3d::UnitZ()};
  const PredictedAngles angles{.sun_angle_rad = 90.143759304 * kRadPerDeg,
                               .earth_angle_rad = 131.253314001 * kRadPerDeg,
                               .dihedral_rad = 67.046435278 * kRadPerDeg};
  const auto found =
      axis_candidates(config, measured_at(config, angles, sun_earth.disc_rad), sun_earth).value();
  EXPECT_EQ(found.geometry_case, 1);
  EXPECT_FALSE(found.told_apart);
  ASSERT_EQ(found.candidates.size(), 2U);
  constexpr double kPrinted_rad = 4e-9 * kRadPerDeg;
  EXPECT_LT(angle_between_rad(found.candidates[0].axis_icrf, at_deg(268.625, 68.4485)),
            kPrinted_rad);
  EXPECT_LT(angle_between_rad(found.candidates[1].axis_icrf, at_deg(281.751608418, -23.899303556)),
            kPrinted_rad);
}

}  // namespace spindrift::testing::axis_candidates_test
