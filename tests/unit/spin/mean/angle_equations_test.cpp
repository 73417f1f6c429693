#include "pipelines/spin/mean/angle_equations.h"

#include <Eigen/Dense>
#include <random>

#include "pipelines/frames/celestial.h"
#include "pipelines/spin/sensor_model/horizon.h"
#include "tests/support/axis_scene.h"
#include "tests/support/matchers.h"
#include "tests/support/misaligned.h"
#include "tests/support/normalised_square.h"

namespace spindrift::testing::angle_equations_test {

using Scene = AxisScene;
using enum SpinQuantity;

/// The step is small enough for linearity and ten thousand times the rounding to nanoseconds.
constexpr double kStep_rad = 2e-5;

/// Returns the measurements with all quantities but one rejected.
RevolutionMeasurements only(SpinQuantity quantity, const SpinConfig& config,
                            Revolution revolution) {
  if (quantity == MixedAzimuth) {
    revolution.edges.at(index_of(PulseChannel::Sun1)).reset();
  }
  RevolutionMeasurements measured = measure(config, revolution);
  for (const SpinQuantity other : kMeasuredAngles) {
    if (other != quantity) {
      reject(measured, other, rejection_of(other));
    }
  }
  return measured;
}

/// Returns the equations of one revolution, counted from the axis about which they are linear.
AngleEquations equations_of(const SpinConfig& config, const RevolutionMeasurements& measured,
                            const SunEarthDirections& sun_earth, const Eigen::Vector3d& axis_icrf) {
  AngleEquations equations{axis_icrf};
  equations.add(config, measured, sun_earth, axis_icrf);
  return equations;
}

/// Expects equations that are linear in one unknown while the others are zero: the residual is the
/// slope times the step, so the right-hand side is the normal matrix times the step.
void expect_linear(const AngleEquations& equations, int unknown, double step_rad) {
  ASSERT_EQ(equations.angles(), 1);
  const Eigen::VectorXd slopes = equations.normal().col(unknown);
  // The largest deviation is the curvature of a chord, 20 times the step.
  EXPECT_LT((equations.right() - slopes * step_rad).norm(), 1e-3 * slopes.norm() * kStep_rad);
  EXPECT_NEAR(equations.squares(), slopes(unknown) * step_rad * step_rad,
              2e-3 * slopes(unknown) * step_rad * step_rad + 1e-12);
}

struct AngleEquationsTest : ::testing::Test {
  Scene scene;
};

TEST_F(AngleEquationsTest, SlopesToTheAxisAreDifferencesOfResiduals) {
  for (const SpinQuantity quantity : kMeasuredAngles) {
    SCOPED_TRACE(name_of(quantity));
    const RevolutionMeasurements measured = only(quantity, scene.config, scene.seen());
    for (const int across : {0, 1}) {
      for (const double step_rad : {kStep_rad, -kStep_rad}) {
        const Eigen::Vector3d beside_icrf =
            (scene.axis_icrf - step_rad * tangent_basis(scene.axis_icrf).col(across)).normalized();
        expect_linear(equations_of(scene.config, measured, scene.sun_earth(), beside_icrf), across,
                      step_rad);
      }
    }
  }
}

TEST_F(AngleEquationsTest, AnAxisBesideTheReferenceIsCountedFromThere) {
  const RevolutionMeasurements measured = scene.measured();
  const Eigen::Vector3d reference_icrf =
      (scene.axis_icrf + kStep_rad * Eigen::Vector3d::UnitX()).normalized();
  for (const Eigen::Vector3d& about_icrf : {scene.axis_icrf, reference_icrf}) {
    AngleEquations equations{reference_icrf};
    equations.add(scene.config, measured, scene.sun_earth(), about_icrf);
    EXPECT_EQ(equations.angles(), 5);
    // The angles have at most degrees of correlated noise. What remains is the square of the step
    // and the radian of the reference's weight.
    EXPECT_LT(angle_between_rad(equations.axis_icrf(), scene.axis_icrf), 2e-3 * kStep_rad);
  }
}

TEST_F(AngleEquationsTest, SlopesToTheLimbAreThoseOfALargerDisc) {
  SunEarthDirections larger = scene.sun_earth();
  larger.disc_rad += kStep_rad;
  for (const auto& [quantity, error] :
       {std::pair{NorthChord, NorthLimb}, std::pair{SouthChord, SouthLimb}}) {
    expect_linear(equations_of(scene.config, only(quantity, scene.config, scene.seen()), larger,
                               scene.axis_icrf),
                  2 + error, kStep_rad);
  }
}

TEST_F(AngleEquationsTest, SlopesToTheAzimuthsAreThoseOfAWrongMissionFile) {
  SpinConfig wrong = scene.config;
  wrong.north->azimuth_rad -= kStep_rad;
  wrong.south->azimuth_rad -= kStep_rad;
  for (const auto& [quantity, error] :
       {std::pair{NorthDihedral, NorthAzimuth}, std::pair{SouthDihedral, SouthAzimuth}}) {
    expect_linear(equations_of(wrong, only(quantity, wrong, scene.seen()), scene.sun_earth(),
                               scene.axis_icrf),
                  2 + error, kStep_rad);
  }
}

TEST_F(AngleEquationsTest, SlopesToTheSunAngleAreThoseOfAWrongSeparation) {
  SpinConfig wrong = scene.config;
  wrong.sun_sensor.slit_separation_rad += kStep_rad;
  const double too_large_rad =
      measure(wrong, scene.seen()).sun_angle->value_rad - scene.measured().sun_angle->value_rad;
  EXPECT_GT(too_large_rad, 0.0);
  for (const SpinQuantity quantity : {SunAngle, MixedAzimuth}) {
    expect_linear(equations_of(wrong, only(quantity, wrong, scene.seen()), scene.sun_earth(),
                               scene.axis_icrf),
                  2 + SunAngleError, too_large_rad);
  }
}

/// Expects the right-hand side that a step of an error makes by its slope.
void expect_slope(const AngleEquations& equations, SpinAlignmentError error, double step) {
  const Eigen::VectorXd slopes = equations.considered().shared.col(kChannelOffsets + error);
  // Of no slope, rounding to nanoseconds is left.
  EXPECT_LE((equations.right() - slopes * step).norm(),
            2e-3 * equations.right().norm() + 1e-4 * kStep_rad * equations.normal().norm());
}

TEST_F(AngleEquationsTest, SlopesToTheAlignmentAreThoseOfAWrongMissionFile) {
  for (const SpinQuantity quantity : kMeasuredAngles) {
    SCOPED_TRACE(name_of(quantity));
    for (int error = 0; error < Co2AltitudeError; ++error) {
      SCOPED_TRACE(kSpinAlignmentKeys.at(static_cast<std::size_t>(error)));
      const SpinConfig said =
          true_config(scene.config, -kStep_rad * SpinAlignmentVector::Unit(error));
      expect_slope(equations_of(said, only(quantity, said, scene.seen()), scene.sun_earth(),
                                scene.axis_icrf),
                   static_cast<SpinAlignmentError>(error), kStep_rad);
    }
    const RevolutionMeasurements measured = only(quantity, scene.config, scene.seen());
    constexpr double kStep_km = 0.2;
    SunEarthDirections smaller = scene.sun_earth();
    smaller.disc_rad -=
        std::tan(smaller.disc_rad) * kStep_km / horizon_axes(scene.config.horizon).equatorial_km;
    expect_slope(equations_of(scene.config, measured, smaller, scene.axis_icrf), Co2AltitudeError,
                 kStep_km);
    constexpr double kLate_s = 0.02;
    SunEarthDirections late = scene.sun_earth();
    late.earth_motion_icrf_s = Eigen::Vector3d{3e-4, -5e-4, 2e-4};
    late.disc_rad -=
        std::tan(late.disc_rad) * late.earth_motion_icrf_s.dot(late.earth_icrf) * kLate_s;
    late.earth_icrf = (late.earth_icrf + kLate_s * late.earth_motion_icrf_s).normalized();
    expect_slope(equations_of(scene.config, measured, late, scene.axis_icrf), TimeTagError,
                 kLate_s);
  }
}

TEST_F(AngleEquationsTest, AChannelThatIsLateMovesTheAxisByItsOffset) {
  const auto axis_of = [&](const Revolution& revolution) {
    return equations_of(scene.config, measure(scene.config, revolution), scene.sun_earth(),
                        scene.axis_icrf);
  };
  const AngleEquations in_time = axis_of(scene.seen());
  const double late_s = kStep_rad / scene.rate_rad_s;
  for (std::size_t channel = 0; channel < kPulseChannels; ++channel) {
    SCOPED_TRACE(name_of(static_cast<PulseChannel>(channel)));
    Revolution late = scene.seen();
    late.edges.at(channel) = shifted(*late.edges.at(channel), late_s);
    const Eigen::Vector2d moved_rad = tangent_basis(scene.axis_icrf).transpose() *
                                      (axis_of(late).axis_icrf() - in_time.axis_icrf());
    const Eigen::Vector2d expected_rad =
        in_time.considered_shift().col(static_cast<Eigen::Index>(channel)) * late_s;
    // The period adds noise of its own to the dihedrals, a few percent of that of the edges.
    EXPECT_LT((moved_rad - expected_rad).norm(), 0.05 * expected_rad.norm() + 1e-3 * kStep_rad);
  }
}

TEST_F(AngleEquationsTest, AChordThatGrazesTheLimbIsLeftOut) {
  const double disc_rad = scene.sun_earth().disc_rad;
  const double earth_rad = angle_between_rad(scene.axis_icrf, scene.earth_icrf);
  scene.config.north->mount_angle_rad = earth_rad - disc_rad + 0.005;
  const AngleEquations equations =
      equations_of(scene.config, scene.measured(), scene.sun_earth(), scene.axis_icrf);
  EXPECT_EQ(equations.angles(), 4);
}

TEST(AngleEquations, CovarianceIsTheScatterOfTheAxis) {
  constexpr int kDraws = 3000;
  Scene scene;
  scene.config.noise = {.sun_s = 2e-5, .infrared_s = 1e-4};
  const Revolution exact = scene.seen();
  std::mt19937_64 rng{31};
  double squares = 0.0;
  for (int draw = 0; draw < kDraws; ++draw) {
    const AngleEquations equations =
        equations_of(scene.config, measure(scene.config, noisy(scene, exact, rng)),
                     scene.sun_earth(), scene.axis_icrf);
    const Eigen::Vector2d error_rad =
        tangent_basis(scene.axis_icrf).transpose() * equations.axis_icrf();
    squares += normalised_square(error_rad, equations.covariance_rad2());
  }
  // Chi-square with 6000 degrees of freedom has a standard deviation of sqrt(12000); 99.9 %.
  EXPECT_NEAR(squares, 2.0 * kDraws, 3.29 * 109.5);
}

TEST_F(AngleEquationsTest, WhatNoAngleFixesStaysAtTheReference) {
  const AngleEquations none{scene.axis_icrf};
  EXPECT_LT(angle_between_rad(none.axis_icrf(), scene.axis_icrf), 1e-15);
  EXPECT_TRUE(none.covariance_rad2().isApprox(Eigen::Matrix2d::Identity()));

  const AngleEquations sun_only = equations_of(
      scene.config, only(SunAngle, scene.config, scene.seen()), scene.sun_earth(), scene.axis_icrf);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver{sun_only.covariance_rad2()};
  EXPECT_NEAR(solver.eigenvalues()(1), 1.0, 1e-7);
  EXPECT_LT(solver.eigenvalues()(0), 1e-6);
}

}  // namespace spindrift::testing::angle_equations_test
