/// The geometry at one time of a pass, compared with closed forms and with
/// pipelines/spin/README.md.

#include "pipelines/spin/planning/pass_geometry.h"

#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "pipelines/ephemeris/sun.h"
#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/spin/measurement/measurement.h"
#include "pipelines/spin/planning/pass_conditions.h"
#include "services/reports/planned_pass.h"
#include "tests/support/matchers.h"
#include "tests/support/observed_spin.h"
#include "tests/support/recorded_pass.h"

namespace spindrift::testing::pass_geometry_test {

PassGeometry at(const SpinConfig& config, const Orbit& orbit, const Eigen::Vector3d& axis_icrf,
                TaiTime t, double rate_rad_s = 2.0 * std::numbers::pi) {
  return PassScene{config, orbit, axis_icrf, rate_rad_s}.at(t).value();
}

std::vector<std::string> sentences_of(const SpinConfig& config, const PassGeometry& geometry) {
  std::vector<std::string> sentences;
  for (const PassCondition& condition : conditions_of(config, geometry)) {
    sentences.push_back(sentence_of(condition));
  }
  return sentences;
}

/// Returns the geometry at the start of a recorded pass with these sensors.
PassGeometry first_of(const RecordedPass& pass, const SpinConfig& config) {
  return at(config, pass.orbit, pass.true_axis_icrf, pass.pulses.front().t, pass.true_rate_rad_s);
}

TEST(PassGeometry, HasTheFiguresOfTheNominalPass) {
  const auto pass = recorded_pass("nominal");
  const PassGeometry first = first_of(pass, pass.config);
  // Source: truth.json, which holds for the start of the pass, up to half a turn earlier.
  EXPECT_NEAR(first.angles.sun_angle_rad / kRadPerDeg, 96.23210, 1e-3);
  EXPECT_NEAR(first.angles.earth_angle_rad / kRadPerDeg, 90.88075, 0.01);
  EXPECT_NEAR(first.disc_rad / kRadPerDeg, 27.46558, 0.01);
  EXPECT_NEAR(first.beams.at(index_of(Side::North)).chord_rad.value(),
              0.1491403704 * pass.true_rate_rad_s, 0.02 * kRadPerDeg);
  EXPECT_EQ(first.fix.geometry_case, 1);
  EXPECT_EQ(first.fix.axes, 1U);
  EXPECT_TRUE(first.fix.told_apart);
}

TEST(PassGeometry, ExpectsOfAFixWhatFixesOfTheNominalPassScatter) {
  const auto pass = recorded_pass("nominal");
  PassScene scene{pass.config, pass.orbit, pass.true_axis_icrf, pass.true_rate_rad_s};
  double sum_rad2 = 0.0;
  constexpr int kTimes = 60;
  for (int i = 0; i < kTimes; ++i) {
    const PassGeometry geometry = scene.at(shifted(pass.pulses.front().t, 10.0 * i)).value();
    sum_rad2 += geometry.fix.sigma_rad.value() * geometry.fix.sigma_rad.value();
  }
  // pipelines/spin/README.md: the two-chord fix scatters by 0.426 deg over 600 turns, which is
  // known to 3 %.
  EXPECT_NEAR(std::sqrt(sum_rad2 / kTimes) / kRadPerDeg, 0.426, 3.0 * 0.03 * 0.426);
}

TEST(PassGeometry, SeesChordsByTheClosedForm) {
  const Orbit orbit = orbit_across_the_earth();
  std::mt19937_64 rng{17};
  std::uniform_real_distribution<double> uniform;
  std::array<int, 5> views{};
  for (int trial = 0; trial < 3000; ++trial) {
    SCOPED_TRACE(trial);
    SpinConfig config = usual_config();
    config.north->mount_angle_rad = (5.0 + 170.0 * uniform(rng)) * kRadPerDeg;
    const Eigen::Vector3d axis_icrf = direction_icrf(
        {.ra_rad = 6.28 * uniform(rng), .dec_rad = std::asin(2.0 * uniform(rng) - 1.0)});
    // In half of the trials the Earth is close and fills the sky. The spin is so fast that the
    // Earth hardly moves within a turn.
    const double t_s = trial % 2 == 0 ? 34'400.0 + 800.0 * uniform(rng) : 40'000.0 * uniform(rng);
    const PassGeometry geometry =
        at(config, orbit, axis_icrf, shifted(kTransferStart, t_s), 1000.0);
    const BeamGeometry& beam = geometry.beams.at(index_of(Side::North));
    ++views.at(static_cast<std::size_t>(beam.view));
    // The beam moves on a circle about the axis; these are its extreme distances from the Earth.
    const double mount_rad = config.north->mount_angle_rad;
    const double sum_rad = mount_rad + geometry.angles.earth_angle_rad;
    const double nearest_rad = std::abs(mount_rad - geometry.angles.earth_angle_rad);
    const double farthest_rad = std::min(sum_rad, 2.0 * std::numbers::pi - sum_rad);
    const bool meets = nearest_rad < geometry.disc_rad && farthest_rad > geometry.disc_rad;
    switch (beam.view) {
      case BeamSight::Misses:
        EXPECT_GT(nearest_rad, geometry.disc_rad);
        break;
      case BeamSight::Inside:
        EXPECT_LT(farthest_rad, geometry.disc_rad);
        break;
      case BeamSight::NearTangent:
        EXPECT_TRUE(meets);
        break;
      case BeamSight::Crosses: {
        // In a turn of 6 ms the Earth moves by 6e-6 rad, to which a chord near the limb is ten
        // times as sensitive at either end.
        const auto chord_rad =
            predict_chord_rad(mount_rad, geometry.angles.earth_angle_rad, geometry.disc_rad);
        EXPECT_TRUE(meets);
        ASSERT_TRUE(chord_rad);
        EXPECT_NEAR(*chord_rad, beam.chord_rad.value(), 5e-4);
        break;
      }
      case BeamSight::NoSensor:
        FAIL();
    }
  }
  for (const BeamSight view :
       {BeamSight::Misses, BeamSight::NearTangent, BeamSight::Crosses, BeamSight::Inside}) {
    EXPECT_GT(views.at(static_cast<std::size_t>(view)), 0) << static_cast<int>(view);
  }
}

TEST(PassGeometry, DeltaIsTheDeterminantOfTheTwoEquations) {
  const auto body = body_across_the_earth();
  const PassGeometry geometry =
      at(body.config, orbit_across_the_earth(), body.axis_icrf, kTransferStart, body.rate_rad_s);
  const auto& [sun_rad, earth_rad, dihedral_rad] = geometry.angles;
  for (const Side side : kSides) {
    const BeamGeometry& beam = geometry.beams.at(index_of(side));
    const double mount_rad = sensor_of(body.config, side)->mount_angle_rad;
    Eigen::Matrix2d equations;
    equations << std::cos(mount_rad), std::sin(mount_rad) * std::cos(0.5 * *beam.chord_rad),
        std::cos(sun_rad), std::sin(sun_rad) * std::cos(dihedral_rad);
    EXPECT_NEAR(beam.delta.value(), equations.determinant(), 1e-12);
  }
}

TEST(PassGeometry, DeltaHasTheClassesOfTheMission) {
  const SpinGeometry limits{.determinant_usable = 0.03, .determinant_ambiguous = 0.01};
  EXPECT_EQ(class_of(limits, -0.03), DeltaClass::Usable);
  EXPECT_EQ(class_of(limits, 0.0299), DeltaClass::TwoRoots);
  EXPECT_EQ(class_of(limits, -0.0101), DeltaClass::TwoRoots);
  EXPECT_EQ(class_of(limits, 0.01), DeltaClass::Ambiguous);
  EXPECT_EQ(class_of(limits, 0.0), DeltaClass::Ambiguous);
}

TEST(PassGeometry, WithOneBeamTheFixIsByItsChord) {
  const auto pass = recorded_pass("nominal");
  SpinConfig config = pass.config;
  config.south.reset();
  const PassGeometry geometry = first_of(pass, config);
  EXPECT_EQ(geometry.fix.geometry_case, 2);
  EXPECT_EQ(geometry.beams.at(index_of(Side::South)).view, BeamSight::NoSensor);
  const auto words = sentences_of(config, geometry);
  EXPECT_THAT(words, Contains("fix by case 2: one axis"));
  EXPECT_THAT(words, Contains("north beam sees the Earth"));
  EXPECT_THAT(words, Not(Contains(HasSubstr("south"))));
}

/// Returns an orbit that passes `offset_rad` from the line between Earth and Sun.
Orbit orbit_through_the_sun(TaiTime t, double range_km, double offset_rad) {
  const RaDec sun = ra_dec_of(geometric_sun_icrf_km(t));
  const double inclination_rad = 40.0 * kRadPerDeg;
  const double argument_rad = std::asin(std::sin(sun.dec_rad) / std::sin(inclination_rad));
  const double node_to_sun_rad =
      std::atan2(std::sin(argument_rad) * std::cos(inclination_rad), std::cos(argument_rad));
  return Orbit{KeplerOrbit::make({.epoch = t,
                                  .semi_major_axis_km = range_km,
                                  .eccentricity = 0.0,
                                  .inclination_rad = inclination_rad,
                                  .raan_rad = sun.ra_rad - node_to_sun_rad,
                                  .argument_of_perigee_rad = argument_rad,
                                  .mean_anomaly_rad = offset_rad})
                   .value()};
}

/// Returns the axis perpendicular to Sun and Earth, with which both beams see the Earth.
Eigen::Vector3d axis_across(const Orbit& orbit, TaiTime t) {
  return geometric_sun_icrf_km(t).cross(orbit.at(t).value().position_icrf_km).normalized();
}

/// Returns the geometry where the spacecraft is this angle from the line between Earth and Sun.
PassGeometry beside_the_sun(const SpinConfig& config, double offset_deg) {
  const TaiTime t = kTransferStart;
  const Orbit orbit = orbit_through_the_sun(t, 20'000.0, offset_deg * kRadPerDeg);
  return at(config, orbit, axis_across(orbit, t), t);
}

TEST(PassGeometry, NoAxisIsFoundWhereSunAndEarthAreInLine) {
  const SpinConfig config = usual_config();
  const PassGeometry in_line = beside_the_sun(config, 2.9);
  EXPECT_NEAR(in_line.sun_earth_rad / kRadPerDeg, 177.1, 0.05);
  EXPECT_TRUE(in_line.in_line);
  EXPECT_FALSE(in_line.sun_hidden);
  EXPECT_FALSE(in_line.fix.sigma_rad);
  EXPECT_THAT(sentences_of(config, in_line), Contains("no fix (case 1): Sun and Earth in line"));
  const PassGeometry beside = beside_the_sun(config, 3.2);
  EXPECT_FALSE(beside.in_line);
  EXPECT_TRUE(beside.fix.sigma_rad);
}

TEST(PassGeometry, TheEarthHidesTheSun) {
  const SpinConfig config = usual_config();
  const double disc_deg = std::asin(6418.137 / 20'000.0) / kRadPerDeg;
  const PassGeometry night = beside_the_sun(config, 180.0 + disc_deg - 0.1);
  EXPECT_TRUE(night.sun_hidden);
  EXPECT_EQ(night.fix.geometry_case, 8);
  EXPECT_FALSE(night.beams.front().delta);
  EXPECT_THAT(sentences_of(config, night), Contains("the Earth hides the Sun: no sun pulses"));
  const PassGeometry day = beside_the_sun(config, 180.0 + disc_deg + 0.1);
  EXPECT_FALSE(day.sun_hidden);
  EXPECT_EQ(day.fix.geometry_case, 1);
}

TEST(PassGeometry, SaysWhichSlitCannotSeeTheSun) {
  const TaiTime t = kTransferStart;
  const Orbit orbit = orbit_across_the_earth();
  const Eigen::Vector3d sun_icrf = geometric_sun_icrf_km(t).normalized();
  const auto words_at = [&](double sun_angle_deg) {
    const double angle_rad = sun_angle_deg * kRadPerDeg;
    const SpinConfig config = usual_config();
    return sentences_of(
        config,
        at(config, orbit,
           std::cos(angle_rad) * sun_icrf + std::sin(angle_rad) * sun_icrf.unitOrthogonal(), t));
  };
  // A slit canted by 45 deg reaches to 45 deg from the axis.
  EXPECT_THAT(words_at(50.0), Not(Contains(HasSubstr("slit"))));
  EXPECT_THAT(words_at(40.0), Contains("slit 2 cannot see the Sun"));
  EXPECT_THAT(words_at(0.3), Contains("the Sun stands too near the spin axis for either slit"));
}

TEST(PassGeometry, SaysWhatSpoilsAFix) {
  const auto body = body_across_the_earth();
  SpinConfig config = body.config;
  const auto geometry = [&] {
    return at(config, orbit_across_the_earth(), body.axis_icrf, kTransferStart, body.rate_rad_s);
  };
  const auto words = [&] { return sentences_of(config, geometry()); };
  const double delta = std::abs(geometry().beams.at(index_of(Side::North)).delta.value());
  config.geometry = {.determinant_usable = 1.0, .determinant_ambiguous = 0.5 * delta};
  EXPECT_THAT(words(), Contains("|Delta| < 1 (north): a fix by its chord alone has two roots to "
                                "tell apart"));
  config.geometry = {.determinant_usable = 1.0, .determinant_ambiguous = 0.5};
  EXPECT_THAT(words(), Contains("|Delta| <= 0.5 (north): a fix by its chord alone is ambiguous"));
  EXPECT_THAT(words(), Contains("fix by case 1: one axis"));
  // The window is longer than half a turn, so all channels meet.
  config.screening.interference_s = 1.0;
  EXPECT_THAT(words(), Contains("interference: sun1 and south_out meet"));
  EXPECT_THAT(words(), Contains("no fix (case 0): nothing that tells of the axis"));
}

TEST(PassGeometry, BelowTheHorizonIsAnError) {
  const Orbit orbit = orbit_across_the_earth();
  SpinConfig config = usual_config();
  config.horizon.co2_altitude_km = 30'000.0;
  EXPECT_THAT((PassScene{config, orbit, Eigen::Vector3d::UnitZ(), 1.0}.at(kTransferStart)),
              IsRefused(ErrorCode::Unobservable, _));
}

}  // namespace spindrift::testing::pass_geometry_test
