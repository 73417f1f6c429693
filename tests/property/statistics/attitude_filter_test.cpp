/// Errors and innovations of the attitude filter over many passes are consistent with its
/// covariance, and the filter converges from a large initial error.

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>
#include <string>

#include "pipelines/frames/angle.h"
#include "pipelines/three_axis/attitude_estimator.h"
#include "tests/support/turning_body.h"

namespace spindrift::testing::attitude_filter_test {

using Eigen::Vector3d;

constexpr int kPasses = 200;
constexpr double kGyro_hz = 4.0;
const Vector3d kSun = Vector3d{0.3, -0.8, 0.5}.normalized();
const Vector3d kField = Vector3d{0.9, 0.4, 0.1}.normalized();
constexpr double kVector_rad = 0.5 * kRadPerDeg;

/// Expects a sum of chi-squares in its central 95 %.
void expect_in_band(double sum, double freedom, const std::string& what) {
  const double half_width = 1.96 * std::sqrt(2.0 * freedom);
  EXPECT_NEAR(sum, freedom, half_width) << what;
}

/// Names the sensors that deliver once a second after a first star fix.
struct Equipment {
  std::string name;
  bool star;
  bool sun;
  bool field;
};

struct Tally {
  double squared_errors_midway = 0.0;
  double squared_errors = 0.0;
  double squared_innovations = 0.0;
  double innovations = 0.0;  ///< Degrees of freedom of the innovations.
};

double squared_error(const Mekf& filter, const TurningBody& body, const Sensors& sensors,
                     double t_s) {
  Eigen::Matrix<double, 6, 1> error;
  error << error_rad(filter.q_icrf_body(), body.q_icrf_body(t_s)),
      sensors.bias_rad_s() - filter.bias_rad_s();
  return error.dot(filter.covariance().ldlt().solve(error));
}

void run_pass(const Equipment& equipment, std::mt19937_64& rng, Tally& tally) {
  constexpr int kSeconds = 120;
  const ThreeAxisConfig config = usual_three_axis();
  const TurningBody body = TurningBody::smooth(rng, kSeconds, 0.6 * kRadPerDeg);
  Sensors sensors{body, config, rng};
  AttitudeEstimator estimator{config};
  AttitudeEstimator::Products products;
  const auto take = [&](const auto& sample, const auto& observed, double freedom) {
    if (estimator.filter()) {
      tally.squared_innovations += estimator.filter()->innovation(observed).nis;
      tally.innovations += freedom;
    }
    estimator.push(sample, products);
  };
  const auto direction = [&](double t_s, SampleKind kind, const Vector3d& ref) {
    const SeenDirection seen{
        at_s(t_s), kind, {sensors.direction(t_s, ref, kVector_rad), ref, kVector_rad}};
    take(seen, seen, 2.0);
  };
  for (int i = 0; i <= kSeconds * kGyro_hz; ++i) {
    const double t_s = i / kGyro_hz;
    estimator.push(sensors.gyro(t_s), products);
    if (i % static_cast<int>(kGyro_hz) != 0) {
      continue;
    }
    if (equipment.star || i == 0) {
      const StarFix fix = sensors.star(t_s);
      take(fix,
           ObservedAttitude{fix.q_icrf_sensor * config.star_tracker->q_body_sensor.conjugate(),
                            config.star_tracker->noise_rad},
           3.0);
    }
    if (equipment.sun) {
      direction(t_s, SampleKind::Sun, kSun);
    }
    if (equipment.field) {
      direction(t_s, SampleKind::Magnetometer, kField);
    }
    if (i == kSeconds * kGyro_hz / 2) {
      tally.squared_errors_midway += squared_error(*estimator.filter(), body, sensors, t_s);
    }
  }
  tally.squared_errors += squared_error(*estimator.filter(), body, sensors, kSeconds);
}

TEST(AttitudeFilterStatistics, ErrorsAndInnovationsAreThoseOfTheCovariance) {
  std::mt19937_64 rng{1201};
  for (const Equipment& equipment :
       {Equipment{"star", true, false, false}, Equipment{"star and sun", true, true, false},
        Equipment{"sun", false, true, false}, Equipment{"sun and field", false, true, true}}) {
    Tally tally;
    for (int pass = 0; pass < kPasses; ++pass) {
      run_pass(equipment, rng, tally);
    }
    expect_in_band(tally.squared_errors_midway, 6.0 * kPasses, equipment.name + ", NEES at 60 s");
    expect_in_band(tally.squared_errors, 6.0 * kPasses, equipment.name + ", NEES at 120 s");
    expect_in_band(tally.squared_innovations, tally.innovations, equipment.name + ", NIS");
  }
}

TEST(AttitudeFilterStatistics, FromThirtyDegreesOffTwoDirectionsLeadBackAlways) {
  std::mt19937_64 rng{1202};
  constexpr int kTrials = 100;
  constexpr int kSeconds = 60;
  const ThreeAxisConfig config = usual_three_axis();
  const double noise_rad = config.gyro->noise_rad_s / kGyro_hz;
  int converged = 0;
  double squared_errors = 0.0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const TurningBody body = TurningBody::smooth(rng, kSeconds, 0.6 * kRadPerDeg);
    Sensors sensors{body, config, rng};
    const Eigen::Quaterniond off{
        Eigen::AngleAxisd{30.0 * kRadPerDeg, normal_vector(rng, 1.0).normalized()}};
    Mekf filter{{{.q_ref_body = body.q_icrf_body(0.0) * off,
                  .covariance_rad2 = std::pow(30.0 * kRadPerDeg, 2) * Eigen::Matrix3d::Identity()}},
                config.gyro->bias_sigma_rad_s};
    Vector3d rate_rad_s = sensors.gyro(0.0).rate_body_rad_s;
    for (int i = 0; i <= kSeconds * kGyro_hz; ++i) {
      const double t_s = i / kGyro_hz;
      if (i > 0) {
        const Vector3d next_rad_s = sensors.gyro(t_s).rate_body_rad_s;
        filter.propagate({1.0 / kGyro_hz, rate_rad_s, next_rad_s}, {noise_rad * noise_rad, 0.0});
        rate_rad_s = next_rad_s;
      }
      if (i % static_cast<int>(kGyro_hz) == 0) {
        for (const Vector3d& ref : {kSun, kField}) {
          filter.update(
              SeenDirection{at_s(t_s),
                            SampleKind::Sun,
                            {sensors.direction(t_s, ref, kVector_rad), ref, kVector_rad}});
        }
      }
    }
    const double error_deg =
        degrees(error_rad(filter.q_icrf_body(), body.q_icrf_body(kSeconds)).norm());
    const double sigma_deg = degrees(std::sqrt(filter.attitude_covariance_rad2().trace()));
    converged += error_deg < 1.0 && sigma_deg < 0.5 ? 1 : 0;
    squared_errors += squared_error(filter, body, sensors, kSeconds);
  }
  EXPECT_EQ(converged, kTrials);
  expect_in_band(squared_errors, 6.0 * kTrials, "from 30 deg off, two directions, NEES");
}

TEST(AttitudeFilterStatistics, FromThirtyDegreesOffNoisyStarFixesLeadBackAlways) {
  std::mt19937_64 rng{1203};
  constexpr int kTrials = 100;
  constexpr int kSeconds = 200;
  ThreeAxisConfig config = usual_three_axis();
  config.star_tracker->noise_rad = 30.0 * kRadPerDeg / std::sqrt(3.0);
  int converged = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const TurningBody body = TurningBody::smooth(rng, kSeconds, 0.6 * kRadPerDeg);
    Sensors sensors{body, config, rng};
    AttitudeEstimator estimator{config};
    AttitudeEstimator::Products products;
    for (int i = 0; i <= kSeconds * kGyro_hz; ++i) {
      const double t_s = i / kGyro_hz;
      estimator.push(sensors.gyro(t_s), products);
      if (i == 0) {
        const Eigen::Quaterniond off{
            Eigen::AngleAxisd{30.0 * kRadPerDeg, normal_vector(rng, 1.0).normalized()}};
        estimator.push(
            StarFix{at_s(0.0), off * body.q_icrf_body(0.0) * config.star_tracker->q_body_sensor},
            products);
      } else if (i % static_cast<int>(kGyro_hz) == 0) {
        estimator.push(sensors.star(t_s), products);
      }
    }
    const double error =
        error_rad(estimator.filter()->q_icrf_body(), body.q_icrf_body(kSeconds)).norm();
    const double sigma = std::sqrt(estimator.filter()->attitude_covariance_rad2().trace());
    converged += error < 3.0 * sigma && degrees(sigma) < 4.0 ? 1 : 0;
  }
  EXPECT_EQ(converged, kTrials);
}

}  // namespace spindrift::testing::attitude_filter_test
