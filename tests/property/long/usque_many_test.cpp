/// Attitude from a gyro and the magnetometer, from an attitude that is wrong by half a turn.

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>
#include <vector>

#include "pipelines/frames/angle.h"
#include "pipelines/three_axis/mekf.h"
#include "pipelines/three_axis/unscented/usque.h"
#include "tests/support/normalised_square.h"
#include "tests/support/tumbling_body.h"

namespace spindrift::testing::usque_many_test {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kGyroNoise_rad_s = 0.002 * kRadPerDeg;
constexpr double kBiasSigma_rad_s = 0.01 * kRadPerDeg;
constexpr double kOrbit_s = kTwoOrbits_s / 2.0;
constexpr int kRuns = 100;

SeenDirection direction_of(const SeenField& field) {
  return {.t = at_s(0.0),
          .kind = SampleKind::Magnetometer,
          .direction = {.body = field.body_nt.normalized(),
                        .ref = field.ref_icrf_nt,
                        .sigma_rad = field.noise_nt / field.ref_icrf_nt.norm()},
          .stronger = (field.body_nt.norm() - field.ref_icrf_nt.norm()) / field.noise_nt};
}

/// The same measurements in both filters.
struct Pair {
  Pair(const UncertainAttitude& start)
      : usque{start, kBiasSigma_rad_s}, mekf{SensitiveAttitude{start}, kBiasSigma_rad_s} {}

  void fly(TumblingBody& body, double duration_s, std::mt19937_64& rng) {
    const Vector3d bias_rad_s = normal_vector(rng, kBiasSigma_rad_s);
    const auto gyro = [&]() -> Vector3d {
      return body.state().rate_body_rad_s + bias_rad_s + normal_vector(rng, kGyroNoise_rad_s);
    };
    RateSpan span{.dt_s = 1.0, .from_rad_s = gyro(), .to_rad_s = Vector3d::Zero()};
    const double noise_rad2 = kGyroNoise_rad_s * kGyroNoise_rad_s;
    while (body.t_s() < duration_s) {
      body.advance(span.dt_s);
      span.to_rad_s = gyro();
      usque.propagate(span, {.turn_rad2 = noise_rad2, .bias_rad2_s2 = 0.0});
      mekf.propagate(span, {.turn_rad2 = noise_rad2, .bias_rad2_s2 = 0.0});
      span.from_rad_s = span.to_rad_s;
      const SeenField field = body.field();
      usque.update(field);
      mekf.update(direction_of(field));
    }
  }

  Usque usque;
  Mekf mekf;
};

double off_deg(const Quaterniond& estimate, const TumblingBody& body) {
  return degrees(error_rad(estimate, body.state().q_icrf_body).norm());
}

TEST(UsqueMany, FindsTheAttitudeFromHalfATurnAway) {
  int found = 0;
  int found_by_mekf = 0;
  for (std::uint64_t run = 0; run < kRuns; ++run) {
    std::mt19937_64 rng{6001 + run};
    TumblingBody body{rng, 2.0 * kRadPerDeg, {}};
    const Quaterniond half_turn =
        quaternion_by(std::numbers::pi * normal_vector(rng, 1.0).normalized());
    Pair pair{{.q_ref_body = body.state().q_icrf_body * half_turn,
               .covariance_rad2 = std::pow(60.0 * kRadPerDeg, 2) * Eigen::Matrix3d::Identity()}};
    pair.fly(body, kOrbit_s, rng);
    found += off_deg(pair.usque.q_icrf_body(), body) < 1.0 ? 1 : 0;
    found_by_mekf += off_deg(pair.mekf.q_icrf_body(), body) < 1.0 ? 1 : 0;
  }
  RecordProperty("found", found);
  RecordProperty("found_by_mekf", found_by_mekf);
  EXPECT_GE(found, 95);
}

TEST(UsqueMany, IsNoWorseThanTheExtendedFilterInSteadyState) {
  double squares = 0.0;
  double squares_of_mekf = 0.0;
  double nees = 0.0;
  for (std::uint64_t run = 0; run < kRuns; ++run) {
    std::mt19937_64 rng{6101 + run};
    TumblingBody body{rng, 2.0 * kRadPerDeg, {}};
    const double sigma_rad = 1.0 * kRadPerDeg;
    Pair pair{
        {.q_ref_body = body.state().q_icrf_body * quaternion_by(normal_vector(rng, sigma_rad)),
         .covariance_rad2 = sigma_rad * sigma_rad * Eigen::Matrix3d::Identity()}};
    pair.fly(body, 600.0, rng);
    squares += std::pow(off_deg(pair.usque.q_icrf_body(), body), 2);
    squares_of_mekf += std::pow(off_deg(pair.mekf.q_icrf_body(), body), 2);
    nees += normalised_square<3>(error_rad(pair.usque.q_icrf_body(), body.state().q_icrf_body),
                                 pair.usque.attitude_covariance_rad2());
  }
  RecordProperty("ratio", std::to_string(std::sqrt(squares / squares_of_mekf)));
  RecordProperty("nees", std::to_string(nees / kRuns));
  EXPECT_LT(std::sqrt(squares / squares_of_mekf), 1.02);
  EXPECT_NEAR(nees, 3.0 * kRuns, 1.96 * std::sqrt(6.0 * kRuns));
}

}  // namespace spindrift::testing::usque_many_test
