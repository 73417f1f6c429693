/// The sigma of the mean axis and of the spin rate are promises: over many passes the errors
/// divided by them have the statistics that they claim.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>

#include "pipelines/ephemeris/kepler_orbit.h"
#include "pipelines/ephemeris/sun.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/spin/spin_pass.h"
#include "tests/support/product_text.h"
#include "tests/support/spinning_body.h"

namespace spindrift {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kDegree_rad = kPi / 180.0;
constexpr int kPasses = 40;
constexpr double kRevolutions = 150.0;
const TaiTime kStart = tai_from_ns(1'795'143'637'000'000'000);

/// A transfer orbit, two and a half Earth radii up and climbing.
Orbit transfer_orbit() {
  return Orbit{KeplerOrbit::make({.epoch = kStart,
                                  .semi_major_axis_km = 24400.0,
                                  .eccentricity = 0.73,
                                  .inclination_rad = 27.0 * kDegree_rad,
                                  .raan_rad = 0.5,
                                  .argument_of_perigee_rad = 3.0,
                                  .mean_anomaly_rad = 0.35})
                   .value()};
}

testing::Surroundings seen_from(const Orbit& orbit) {
  const auto at = [orbit](double t_s) { return orbit.at(shifted(kStart, t_s)).value(); };
  return {
      .sun_icrf =
          [at, sun = ApparentSun{}](double t_s) mutable {
            return sun.direction_icrf(shifted(kStart, t_s), at(t_s));
          },
      .earth_icrf_km = [at](double t_s) -> Eigen::Vector3d { return -at(t_s).position_icrf_km; },
      .horizon_km = testing::spherical_horizon_km(40.0)};
}

/// An axis across the Earth's direction, the Sun within 25 deg of its equator and 20 deg or more
/// off the line through the Earth.
testing::SpinningBody random_body(const testing::Surroundings& around, std::mt19937_64& rng) {
  std::uniform_real_distribution<double> uniform;
  const Eigen::Vector3d sun_icrf = around.sun_icrf(0.5 * kRevolutions);
  const Eigen::Vector3d earth_icrf = around.earth_icrf_km(0.5 * kRevolutions).normalized();
  while (true) {
    const double roll_rad = 2.0 * kPi * uniform(rng);
    const double tilt_rad = (uniform(rng) - 0.5) * 16.0 * kDegree_rad;
    const Eigen::Vector3d across =
        Eigen::AngleAxisd{roll_rad, earth_icrf} * earth_icrf.unitOrthogonal();
    const Eigen::Vector3d axis = Eigen::AngleAxisd{tilt_rad, across.cross(earth_icrf)} * across;
    if (std::abs(angle_between_rad(axis, sun_icrf) - 0.5 * kPi) < 25.0 * kDegree_rad) {
      return {.axis_icrf = axis,
              .rate_rad_s = 2.0 * kPi * (0.95 + 0.1 * uniform(rng)),
              .first_turn_rad = 2.0 * kPi * uniform(rng),
              .config = testing::usual_config()};
    }
  }
}

SpinEstimate last_estimate(const SpinOutput& output) {
  std::optional<SpinEstimate> last;
  for (const SpinProduct& product : output.products) {
    if (const auto* estimate = std::get_if<SpinEstimate>(&product)) {
      last = *estimate;
    }
  }
  return last.value();
}

TEST(SpinStatistics, ErrorsOfAxisAndRateAreThoseThatTheirSigmasPromise) {
  const Orbit orbit = transfer_orbit();
  const testing::Surroundings around = seen_from(orbit);
  std::mt19937_64 rng{121};
  double axis_squares = 0.0;
  double rate_squares = 0.0;
  for (int trial = 0; trial < kPasses; ++trial) {
    const testing::SpinningBody body = random_body(around, rng);
    const auto edges =
        testing::edges_between(body, around, 0.0, kRevolutions * 2.0 * kPi / body.rate_rad_s);
    const SpinEstimate mean = last_estimate(testing::run(
        SpinPass{body.config, orbit}, testing::pulses_from(edges, kStart, body.config.noise, rng)));

    const Eigen::Vector2d error_rad =
        tangent_basis(mean.axis_icrf).transpose() * (body.axis_icrf - mean.axis_icrf);
    axis_squares += error_rad.dot(mean.covariance_rad2.ldlt().solve(error_rad));
    rate_squares +=
        std::pow((mean.spin_rate_rad_s - body.rate_rad_s) / mean.spin_rate_sigma_rad_s, 2);
  }
  // 0.05 % and 99.95 % points of chi-square: 99.9 % of all seeds lie between.
  EXPECT_GT(axis_squares, 44.79);  // 80 degrees of freedom.
  EXPECT_LT(axis_squares, 128.26);
  EXPECT_GT(rate_squares, 16.91);  // 40 degrees of freedom.
  EXPECT_LT(rate_squares, 76.09);
  RecordProperty("axis_squares", std::to_string(axis_squares));
  RecordProperty("rate_squares", std::to_string(rate_squares));
}

}  // namespace
}  // namespace spindrift
