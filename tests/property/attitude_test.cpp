#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <random>
#include <string>
#include <variant>
#include <vector>

#include "pipelines/frames/angle.h"
#include "pipelines/three_axis/three_axis_pass.h"
#include "tests/support/recorded_separation.h"
#include "tests/support/turning_body.h"

namespace spindrift::testing::attitude_test {

using Eigen::Vector3d;

using Sample = std::variant<GyroSample, StarFix, SunDirection>;

/// Returns two minutes of samples: gyro at 4 Hz, star fixes (every tenth of them wrong), and
/// optionally the Sun.
std::vector<Sample> samples_of_a_pass(std::mt19937_64& rng, bool with_sun) {
  const TurningBody body = TurningBody::smooth(rng, 120.0, 0.6 * kRadPerDeg);
  const ThreeAxisConfig config = usual_three_axis();
  Sensors sensors{body, config, rng};
  const Vector3d sun_icrf = geometric_sun_icrf_km(at_s(0.0)).normalized();
  std::vector<Sample> samples;
  for (int i = 0; i < 480; ++i) {
    const double t_s = 0.25 * i;
    samples.push_back(sensors.gyro(t_s));
    if (i % 4 == 1) {
      samples.push_back(sensors.star(t_s + 0.1));
      if (i % 40 == 1 && i > 1) {
        std::get<StarFix>(samples.back()).q_icrf_sensor = any_attitude(rng);
      }
    }
    if (with_sun && i % 4 == 2) {
      samples.push_back(SunDirection{at_s(t_s), sensors.direction(t_s, sun_icrf, 0.01)});
    }
  }
  return samples;
}

std::vector<AttitudeEstimate> estimates_of(const std::vector<Sample>& samples) {
  ThreeAxisPass pass{usual_three_axis(), std::nullopt};
  std::vector<AttitudeEstimate> estimates;
  const auto keep = [&](const ThreeAxisOutput& output) {
    for (const ThreeAxisProduct& product : output.products) {
      if (const auto* estimate = std::get_if<AttitudeEstimate>(&product)) {
        estimates.push_back(*estimate);
      }
    }
  };
  for (const Sample& sample : samples) {
    keep(std::visit([&](const auto& is) { return pass.push(is); }, sample));
  }
  keep(pass.finish());
  return estimates;
}

void expect_same(const std::vector<AttitudeEstimate>& a, const std::vector<AttitudeEstimate>& b,
                 std::chrono::nanoseconds later = {}) {
  ASSERT_EQ(a.size(), b.size());
  ASSERT_GT(a.size(), 400U);
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(a[i].t + later, b[i].t);
    ASSERT_EQ(a[i].q_icrf_body.toRotationMatrix(), b[i].q_icrf_body.toRotationMatrix());
    ASSERT_EQ(a[i].covariance_rad2, b[i].covariance_rad2);
    ASSERT_EQ(a[i].rate_body_rad_s, b[i].rate_body_rad_s);
    ASSERT_EQ(a[i].assessment.quality, b[i].assessment.quality);
  }
}

TEST(Attitude, DoesNotDependOnTheOrderOfArrivalWithinASecond) {
  std::mt19937_64 rng{1301};
  for (int trial = 0; trial < 20; ++trial) {
    const std::vector<Sample> in_order = samples_of_a_pass(rng, true);
    std::vector<std::pair<double, Sample>> arriving;
    std::uniform_real_distribution<double> delay_s{0.0, 0.99};
    for (const Sample& sample : in_order) {
      const TaiTime t = std::visit([](const auto& is) { return is.t; }, sample);
      arriving.emplace_back(seconds_between(at_s(0.0), t) + delay_s(rng), sample);
    }
    std::sort(arriving.begin(), arriving.end(),
              [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<Sample> shuffled;
    for (const auto& [arrival_s, sample] : arriving) {
      shuffled.push_back(sample);
    }
    expect_same(estimates_of(in_order), estimates_of(shuffled));
  }
}

TEST(Attitude, DoesNotDependOnTheSignOfAStarFix) {
  std::mt19937_64 rng{1302};
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<Sample> samples = samples_of_a_pass(rng, true);
    const auto before = estimates_of(samples);
    for (Sample& sample : samples) {
      if (auto* fix = std::get_if<StarFix>(&sample); fix != nullptr && rng() % 2 == 0) {
        fix->q_icrf_sensor.coeffs() *= -1.0;
      }
    }
    expect_same(before, estimates_of(samples));
  }
}

TEST(Attitude, MovesWithTheTime) {
  std::mt19937_64 rng{1303};
  // The Sun is left out because its direction changes with time.
  std::vector<Sample> samples = samples_of_a_pass(rng, false);
  const auto before = estimates_of(samples);
  const std::chrono::nanoseconds later{123'456'789'012'345'678};
  for (Sample& sample : samples) {
    std::visit([&](auto& is) { is.t += later; }, sample);
  }
  expect_same(before, estimates_of(samples), later);
}

TEST(Attitude, TurnsWithTheStars) {
  std::mt19937_64 rng{1304};
  for (int trial = 0; trial < 20; ++trial) {
    const Eigen::Quaterniond turn = any_attitude(rng);
    AttitudeEstimator here{usual_three_axis()};
    AttitudeEstimator there{usual_three_axis()};
    AttitudeEstimator::Products of_here;
    AttitudeEstimator::Products of_there;
    const Vector3d sun_icrf = geometric_sun_icrf_km(at_s(0.0)).normalized();
    for (const Sample& sample : samples_of_a_pass(rng, true)) {
      if (const auto* gyro = std::get_if<GyroSample>(&sample)) {
        here.push(*gyro, of_here);
        there.push(*gyro, of_there);
      } else if (const auto* star = std::get_if<StarFix>(&sample)) {
        here.push(*star, of_here);
        there.push(StarFix{star->t, turn * star->q_icrf_sensor}, of_there);
      } else {
        const auto& sun = std::get<SunDirection>(sample);
        const SeenDirection seen{sun.t, SampleKind::Sun, {sun.sun_body, sun_icrf, 0.01}};
        SeenDirection turned = seen;
        turned.direction.ref = turn * sun_icrf;
        here.push(seen, of_here);
        there.push(turned, of_there);
      }
    }
    ASSERT_EQ(of_here.size(), of_there.size());
    for (std::size_t i = 0; i < of_here.size(); ++i) {
      if (const auto* one = std::get_if<AttitudeEstimate>(&of_here[i])) {
        const auto& other = std::get<AttitudeEstimate>(of_there[i]);
        ASSERT_NEAR(error_rad(turn * one->q_icrf_body, other.q_icrf_body).norm(), 0.0, 1e-11);
        ASSERT_NEAR(
            (one->covariance_rad2 - other.covariance_rad2).norm() / one->covariance_rad2.norm(),
            0.0, 1e-6);
      }
    }
  }
}

/// Names a flown rate profile that is propagated from the true attitude at T1.
struct Flight {
  std::string name;
  double within_deg;
};

TEST(Attitude, FollowsRatesThatWereFlownToTheFixAtTheirEnd) {
  for (const Flight& flight : {Flight{"juno", 0.01}, Flight{"dawn-2015", 0.05}}) {
    const RecordedSeparation flown = recorded_separation(flight.name);
    AttitudeEstimator estimator{flown.sensors};
    AttitudeEstimator::Products products;
    estimator.push(StarFix{flown.gyro.front().t, flown.truth.at("T1").q_icrf_body}, products);
    for (const GyroSample& sample : flown.gyro) {
      estimator.push(sample, products);
    }
    const StarFix& truth = flown.stars.front();
    ASSERT_EQ(flown.gyro.back().t, truth.t);
    const double sigma_deg =
        degrees(std::sqrt(estimator.filter()->attitude_covariance_rad2().trace()));
    const double error_deg =
        degrees(error_rad(estimator.filter()->q_icrf_body(), truth.q_icrf_sensor).norm());
    EXPECT_LT(error_deg, flight.within_deg) << flight.name;
    EXPECT_LT(error_deg, 3.0 * sigma_deg) << flight.name;
  }
}

}  // namespace spindrift::testing::attitude_test
