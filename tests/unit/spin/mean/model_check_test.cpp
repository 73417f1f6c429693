#include "pipelines/spin/mean/model_check.h"

#include <Eigen/Dense>
#include <cmath>
#include <numbers>
#include <random>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "tests/support/axis_scene.h"
#include "tests/support/matchers.h"
#include "tests/support/normalised_square.h"

namespace spindrift::testing::model_check_test {

constexpr double kPi = std::numbers::pi;
// The scene turns once a second.
const AxisScene kScene{.rate_rad_s = 2.0 * kPi};
const SunEarthDirections kSightlines = kScene.sun_earth();
const Eigen::Vector3d kAxis = kScene.axis_icrf;

/// Returns the equations of many revolutions whose sensors differ from `config`; the true noise is
/// `noise_times` the stated one.
AngleEquations equations_of(const SpinConfig& config, double noise_times = 1.0,
                            int revolutions = 400) {
  std::mt19937_64 rng{17};
  AxisScene noisier = kScene;
  noisier.config.noise = {.sun_s = noise_times * config.noise.sun_s,
                          .infrared_s = noise_times * config.noise.infrared_s};
  const Revolution exact = kScene.seen();
  AngleEquations equations{kAxis};
  for (int i = 0; i < revolutions; ++i) {
    equations.add(config, measure(config, noisy(noisier, exact, rng)), kSightlines, kAxis);
  }
  return equations;
}

void expect_silence(const ModelTest& verdict) {
  EXPECT_EQ(verdict.excess_noise, 1.0);
  EXPECT_EQ(verdict.error_rad, 0.0);
  EXPECT_TRUE(verdict.errors_rad2.isZero());
  EXPECT_FALSE(verdict.beyond_allowance);
}

TEST(ModelCheck, SaysNothingWithoutRevolutionsAndOfModelsThatAreRight) {
  expect_silence(test_model(AngleEquations{kAxis}));
  expect_silence(test_model(equations_of(usual_config())));
}

TEST(ModelCheck, DoesNotMindAnAxisBesideTheTrueOne) {
  // Without noise and with so many revolutions a slope wrong by 1/20 would show.
  const SpinConfig config = usual_config();
  const RevolutionMeasurements measured = measure(config, kScene.seen());
  const Eigen::Matrix<double, 3, 2> basis = tangent_basis(kAxis);
  for (const double turned_rad : {0.0, 0.5 * kPi, 1.0, -2.0}) {
    const Eigen::Vector3d beside =
        (kAxis +
         0.1 * kRadPerDeg * (basis * Eigen::Vector2d{std::cos(turned_rad), std::sin(turned_rad)}))
            .normalized();
    AngleEquations equations{beside};
    for (int i = 0; i < 40000; ++i) {
      equations.add(config, measured, kSightlines, beside);
    }
    expect_silence(test_model(equations));
  }
}

TEST(ModelCheck, SeesAnAzimuthThatIsWrong) {
  for (const ModelError error : {NorthAzimuth, SouthAzimuth}) {
    SpinConfig config = usual_config();
    auto& sensor = error == NorthAzimuth ? config.north : config.south;
    sensor->azimuth_rad -= 1.0 * kRadPerDeg;
    const ModelTest verdict = test_model(equations_of(config));
    EXPECT_TRUE(verdict.beyond_allowance);
    EXPECT_GT(verdict.error_rad, 0.3 * kRadPerDeg);
    EXPECT_LT(verdict.error_rad, 3.0 * kRadPerDeg);
    const auto truth =
        (1.0 * kRadPerDeg * Eigen::Matrix<double, kModelErrors, 1>::Unit(error)).eval();
    EXPECT_LT(normalised_square(truth, verdict.errors_rad2), 9.0);
    EXPECT_EQ(verdict.excess_noise, 1.0);
  }
}

TEST(ModelCheck, SeesASunAngleAndALimbThatAreWrong) {
  SpinConfig slit = usual_config();
  // With Sun and Earth perpendicular to the axis, as nearly here, the sun angle hardly affects the
  // other angles.
  slit.sun_sensor.slit_separation_rad += 10.0 * kRadPerDeg;
  EXPECT_TRUE(test_model(equations_of(slit)).beyond_allowance);
  SpinConfig beam = usual_config();
  beam.north->mount_angle_rad += 4.0 * kRadPerDeg;
  EXPECT_TRUE(test_model(equations_of(beam)).beyond_allowance);
}

TEST(ModelCheck, ShowsWhatTheAllowanceExcusesWithoutDoubt) {
  SpinConfig config = usual_config();
  config.north->azimuth_rad += 0.15 * kRadPerDeg;
  const AngleEquations equations = equations_of(config);
  EXPECT_GT(test_model(equations).error_rad, 0.0);
  EXPECT_FALSE(test_model(equations).beyond_allowance);
}

TEST(ModelCheck, MeasuresNoiseThatIsMoreThanStated) {
  const ModelTest verdict = test_model(equations_of(usual_config(), 3.0));
  // The mean square of 2000 angles scatters by 3 %.
  EXPECT_NEAR(verdict.excess_noise, 9.0, 1.2);
  EXPECT_EQ(verdict.error_rad, 0.0);
}

}  // namespace spindrift::testing::model_check_test
