#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <random>
#include <set>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/spin/sensor_model/geometry.h"
#include "tests/support/lone_fix.h"
#include "tests/support/spinning_body.h"

namespace spindrift::testing::spin_fix_test {

using enum SpinQuantity;

constexpr double kPi = std::numbers::pi;
constexpr int kTrials = 600;

/// Holds a body with any axis and one turn in six seconds, so that an edge resolution of 1 ns is
/// 1e-9 rad; Sun and Earth are where its sensors see them.
struct Scene {
  SpinningBody body;
  Eigen::Vector3d sun_icrf;
  Eigen::Vector3d earth_icrf;
  double range_km;

  SunEarthDirections sun_earth() const {
    return {.sun_icrf = sun_icrf,
            .earth_icrf = earth_icrf,
            .disc_rad = earth_disc_half_angle_rad(range_km, 40.0).value(),
            .earth_pole_icrf = Eigen::Vector3d::UnitZ()};
  }
  Revolution seen() const {
    return revolution_seen(body, at_rest(sun_icrf, range_km * earth_icrf),
                           tai_from_ns(1'795'143'637'000'000'000));
  }
};

class Scenes {
 public:
  explicit Scenes(std::uint64_t seed) : rng_{seed} {}

  Eigen::Vector3d direction() { return random_direction(normal_, rng_); }
  double between(double low, double high) { return low + (high - low) * uniform_(rng_); }

  Scene next() {
    const Eigen::Vector3d axis = direction();
    const auto away = [&](double angle_rad) -> Eigen::Vector3d {
      return Eigen::AngleAxisd{angle_rad, axis.cross(direction()).normalized()} * axis;
    };
    SpinConfig config = usual_config();
    config.sun_sensor.slit_cant_rad = between(20.0, 50.0) * kRadPerDeg;
    config.sun_sensor.slit_separation_rad = between(-60.0, 60.0) * kRadPerDeg;
    config.north->mount_angle_rad = between(70.0, 88.0) * kRadPerDeg;
    config.south->mount_angle_rad = between(92.0, 110.0) * kRadPerDeg;
    config.north->azimuth_rad = between(-kPi, kPi);
    config.south->azimuth_rad = between(-kPi, kPi);
    config.noise = {.sun_s = 2e-5, .infrared_s = 1e-4};
    return {.body = {.axis_icrf = axis,
                     .rate_rad_s = 2.0 * kPi / 6.0,
                     .first_turn_rad = between(0.0, 2.0 * kPi),
                     .config = config},
            .sun_icrf = away(between(55.0, 125.0) * kRadPerDeg),
            .earth_icrf = away(between(80.0, 100.0) * kRadPerDeg),
            .range_km = between(9000.0, 20000.0)};
  }

 private:
  std::mt19937_64 rng_;
  std::normal_distribution<double> normal_;
  std::uniform_real_distribution<double> uniform_;
};

/// Within 10 deg of one line, Sun and Earth amplify every error at least sixfold.
bool nearly_in_line(const Scene& scene) {
  return scene.sun_icrf.cross(scene.earth_icrf).norm() < std::sin(10.0 * kRadPerDeg);
}

/// Holds what is left out, and whether a fix may be compared with the truth.
struct Recovered {
  std::uint64_t seed;
  std::set<SpinQuantity> left_out;
  bool (*comparable)(const SpinFix& fix);
};

class SpinFixRecovers : public ::testing::TestWithParam<Recovered> {};

TEST_P(SpinFixRecovers, TheAxis) {
  Scenes scenes{GetParam().seed};
  int recovered = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    SCOPED_TRACE(trial);
    const Scene scene = scenes.next();
    const auto fix =
        lone_fix(scene.body.config, scene.seen(), GetParam().left_out, scene.sun_earth());
    if (!fix || !GetParam().comparable(*fix) || nearly_in_line(scene)) {
      continue;
    }
    ASSERT_LT(angle_between_rad(fix->axis_icrf, scene.body.axis_icrf), 1e-6);
    ASSERT_TRUE(fix->geometry_case != 1 || std::abs(fix->norm - 1.0) <= 1e-6) << fix->norm;
    ++recovered;
  }
  EXPECT_GT(recovered, kTrials / 2);
}

bool has_both_chords(const SpinFix& fix) { return fix.geometry_case == 1; }
bool has_no_alternate(const SpinFix& fix) { return fix.alternates.empty(); }

INSTANTIATE_TEST_SUITE_P(Chords, SpinFixRecovers,
                         ::testing::Values(Recovered{101, {}, has_both_chords},
                                           Recovered{102, {NorthChord}, has_no_alternate},
                                           Recovered{102, {SouthChord}, has_no_alternate}));

TEST(SpinFixProperty, TurnsWithSunAndEarth) {
  Scenes scenes{103};
  int compared = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    SCOPED_TRACE(trial);
    const Scene scene = scenes.next();
    const Revolution seen = scene.seen();
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd{scenes.between(0.0, kPi), scenes.direction()}.toRotationMatrix();
    const SunEarthDirections here = scene.sun_earth();
    const SunEarthDirections there{.sun_icrf = turn * here.sun_icrf,
                                   .earth_icrf = turn * here.earth_icrf,
                                   .disc_rad = here.disc_rad,
                                   .earth_pole_icrf = turn * here.earth_pole_icrf};
    const auto fix_here = lone_fix(scene.body.config, seen, {}, here);
    const auto fix_there = lone_fix(scene.body.config, seen, {}, there);
    ASSERT_EQ(fix_here.has_value(), fix_there.has_value());
    if (!fix_here || nearly_in_line(scene)) {
      continue;
    }
    // Rounding of a number of order 1, amplified at most a hundredfold.
    constexpr double kRounding = 1e-12;
    ASSERT_LT((fix_there->axis_icrf - turn * fix_here->axis_icrf).norm(), kRounding);
    // The covariance is compared as a tensor in space because its east and north axes change.
    const auto in_space = [](const SpinFix& fix) -> Eigen::Matrix3d {
      const Eigen::Matrix<double, 3, 2> basis = tangent_basis(fix.axis_icrf);
      return basis * fix.covariance_rad2 * basis.transpose();
    };
    const Eigen::Matrix3d turned = turn * in_space(*fix_here) * turn.transpose();
    ASSERT_LT((in_space(*fix_there) - turned).norm(), kRounding * turned.norm());
    ASSERT_EQ(fix_there->resolution, fix_here->resolution);
    ++compared;
  }
  EXPECT_GT(compared, kTrials / 2);
}

}  // namespace spindrift::testing::spin_fix_test
