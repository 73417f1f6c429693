#include "pipelines/spin/measurement/beam_view.h"

#include <cmath>

#include "pipelines/frames/celestial.h"
#include "pipelines/spin/sensor_model/geometry.h"
#include "tests/support/axis_scene.h"
#include "tests/support/matchers.h"

namespace spindrift::testing::beam_view_test {

using Scene = AxisScene;

// Three edges, each rounded to 0.5 ns.
constexpr double kNanosecond_rad = 1.5e-9;

/// Holds an oblate Earth that moves, seen obliquely.
struct Oblique {
  Scene scene{.axis_icrf = Eigen::Vector3d{0.5, -0.1, 1.0}.normalized(),
              .earth = HorizonModel::Ellipsoid};
  RevolutionMeasurements measured;
  SunEarthDirections sun_earth;

  Oblique() {
    const Eigen::Vector3d motion_icrf_s{-5e-4, 1e-4, 2e-4};
    const double earth_angle_rad = scene.off_rad(scene.earth_icrf);
    scene.config.horizon.model = HorizonModel::Ellipsoid;
    scene.config.north->mount_angle_rad = earth_angle_rad - 0.1;
    scene.config.south->mount_angle_rad = earth_angle_rad + 0.1;
    measured = measure(scene.config, scene.seen_while_earth_moves(motion_icrf_s));
    sun_earth = scene.sightlines_while_earth_moves(motion_icrf_s);
  }
  BeamViews views_at(const Eigen::Vector3d& axis_icrf) const {
    return views_of_horizon(scene.config, measured, sun_earth, axis_icrf.normalized());
  }
};

TEST(BeamView, OfTheSphereAtRestIsItsDiscFromAnyAxis) {
  const Scene scene;
  const SunEarthDirections sun_earth = scene.sun_earth();
  const BeamViews beams =
      views_of_horizon(scene.config, scene.measured(), sun_earth, scene.axis_icrf);
  const double earth_angle_rad = angle_between_rad(scene.axis_icrf, scene.earth_icrf);
  for (const Side side : kSides) {
    const BeamView& beam = beams.at(index_of(side));
    EXPECT_NEAR(beam.disc_rad, sun_earth.disc_rad, 1e-13);
    EXPECT_NEAR(beam.lead_rad, 0.0, 1e-13);
    EXPECT_NEAR(beam.chord_rad.value(),
                predict_chord_rad(sensor_of(scene.config, side)->mount_angle_rad, earth_angle_rad,
                                  sun_earth.disc_rad)
                    .value(),
                1e-13);
    EXPECT_LT(beam.disc_per_step_icrf.norm(), 1e-13);
    EXPECT_LT(beam.lead_per_step_icrf.norm(), 1e-13);
  }
}

TEST(BeamView, OfAnOblateEarthThatMovesHasTheChordsAndMiddlesOfTheOracle) {
  const Oblique oblique;
  const Scene& scene = oblique.scene;
  const BeamViews beams = oblique.views_at(scene.axis_icrf);
  const double dihedral_rad =
      predict_angles(scene.axis_icrf, scene.sun_icrf, scene.earth_icrf).dihedral_rad;
  for (const Side side : kSides) {
    const BeamView& beam = beams.at(index_of(side));
    const EarthCrossing& crossing = *oblique.measured.crossing(side);
    EXPECT_NEAR(beam.chord_rad.value(), crossing.chord->value_rad, kNanosecond_rad);
    EXPECT_NEAR(wrapped_rad(dihedral_rad - beam.lead_rad), crossing.dihedral->value_rad,
                kNanosecond_rad);
    EXPECT_GT(std::abs(beam.lead_rad), 1e-4);
  }
}

TEST(BeamView, SlopesAreThoseOfSmallStepsOfTheAxis) {
  const Oblique oblique;
  const Eigen::Vector3d& axis_icrf = oblique.scene.axis_icrf;
  const Eigen::Matrix<double, 3, 2> basis = tangent_basis(axis_icrf);
  constexpr double kStep_rad = 1e-5;
  for (const Side side : kSides) {
    const BeamView here = oblique.views_at(axis_icrf).at(index_of(side));
    for (Eigen::Index i = 0; i < 2; ++i) {
      const Eigen::Vector3d step_icrf = kStep_rad * basis.col(i);
      const BeamView after = oblique.views_at(axis_icrf + step_icrf).at(index_of(side));
      const BeamView before = oblique.views_at(axis_icrf - step_icrf).at(index_of(side));
      // The errors are the square of the step of 1e-5 and rounding of 1e-15 over the step, relative
      // to 1.
      EXPECT_NEAR(here.disc_per_step_icrf.dot(basis.col(i)),
                  (after.disc_rad - before.disc_rad) / (2.0 * kStep_rad), 1e-8);
      EXPECT_NEAR(here.lead_per_step_icrf.dot(basis.col(i)),
                  (after.lead_rad - before.lead_rad) / (2.0 * kStep_rad), 1e-8);
    }
    EXPECT_GT(here.disc_per_step_icrf.norm(), 1e-4);
    EXPECT_GT(here.lead_per_step_icrf.norm(), 1e-4);
  }
}

TEST(BeamView, LeadsAreThoseOfTheBeamsThatAnAzimuthRestsOn) {
  const BeamViews beams = {BeamView{.disc_rad = 0.4, .lead_rad = 0.01},
                           BeamView{.disc_rad = 0.4, .lead_rad = 0.03}};
  EdgeNoise noise_rad = EdgeNoise::Zero();
  EXPECT_EQ(lead_rad(beams, noise_rad), 0.0);
  noise_rad(static_cast<Eigen::Index>(PulseChannel::SouthIn)) = 1e-3;
  EXPECT_DOUBLE_EQ(lead_rad(beams, noise_rad), 0.03);
  noise_rad(static_cast<Eigen::Index>(PulseChannel::NorthIn)) = 1e-3;
  EXPECT_DOUBLE_EQ(lead_rad(beams, noise_rad), 0.02);
}

TEST(BeamView, OfABeamThatMissesIsOfOneThatDoesNot) {
  // The view from the equator over the north pole has closed forms of both limbs.
  Scene scene{.sun_icrf = Eigen::Vector3d::UnitY(),
              .earth_icrf = Eigen::Vector3d::UnitX(),
              .axis_icrf = Eigen::Vector3d::UnitZ()};
  const double polar_limb_rad = std::atan(
      6396.752314245 / std::sqrt(Scene::kRange_km * Scene::kRange_km - 6418.137 * 6418.137));
  scene.config.north->mount_angle_rad = std::acos(0.0) - polar_limb_rad - 1e-4;
  const RevolutionMeasurements measured = scene.measured();
  ASSERT_TRUE(measured.crossing(Side::North));
  scene.config.horizon.model = HorizonModel::Ellipsoid;
  const BeamView north =
      views_of_horizon(scene.config, measured, scene.sun_earth(), scene.axis_icrf)[0];
  EXPECT_FALSE(north.chord_rad);
  EXPECT_NEAR(north.disc_rad, polar_limb_rad, 2e-5);
  EXPECT_NEAR(north.lead_rad, 0.0, 1e-12);
}

}  // namespace spindrift::testing::beam_view_test
