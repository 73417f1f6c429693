#include "pipelines/ground_model/link/three_axis_telemetry.h"

#include <algorithm>
#include <cmath>

#include "pipelines/ephemeris/sun.h"
#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/frames/rotation_vector.h"
#include "pipelines/geomagnetism/main_field.h"
#include "services/mission/igrf.h"
#include "tests/support/low_orbit.h"
#include "tests/support/matchers.h"

namespace spindrift::three_axis_telemetry_test {

using Eigen::Vector3d;

constexpr TaiTime kStart = tai_from_ns(1'772'337'637'000'000'000);
constexpr double kNoise = 0.002;

/// Stays in sunlight during the motion.
const Orbit kOrbit = testing::low_orbit(kStart);

/// Returns a motion of one turn in ten minutes that lasts 500 s.
BodyMotion turning() {
  const BodyState start{.q_icrf_body = quaternion_by({1.0, 0.4, -2.0}),
                        .rate_body_rad_s = {0.01, 0.0, 0.0}};
  BodyMotion motion{RigidBody::make(Vector3d{1.0, 2.0, 2.5}.asDiagonal()).value(), start, 0.5};
  for (int i = 0; i < 1000; ++i) {
    motion.step({});
  }
  return motion;
}

ThreeAxisSensors sensors() {
  return {
      .gyro = TrueGyro{.sampling = {0.0, 0.1},
                       .noise_rad_s = kNoise,
                       .bias_rad_s = {0.003, 0.0, -0.002},
                       .range_rad_s = std::nullopt},
      .sun_sensor =
          TrueSunSensor{.sampling = {100.0, 0.1}, .noise_rad = kNoise, .half_cone_rad = kTurn_rad},
      .star_tracker =
          TrueStarTracker{.sampling = {200.0, 0.1},
                          .noise_rad = kNoise,
                          .q_body_sensor = Eigen::Quaterniond{0.5, -0.5, 0.1, 0.7}.normalized()}};
}

ThreeAxisTelemetry sent(const ThreeAxisSensors& sensors, const ThreeAxisFaults& faults,
                        const Orbit& orbit = kOrbit) {
  Chance chance{7};
  return three_axis_telemetry(turning(), kStart, sensors, faults, orbit, chance).value();
}

/// Expects a sum of squares over their variance to be its degrees of freedom within five standard
/// deviations.
void expect_one(double squares, double degrees_of_freedom) {
  EXPECT_NEAR(squares / degrees_of_freedom, 1.0, 5.0 * std::sqrt(2.0 / degrees_of_freedom));
}

TEST(ThreeAxisTelemetry, ComesWhenItIsDue) {
  const ThreeAxisTelemetry telemetry = sent(sensors(), {});
  ASSERT_EQ(telemetry.gyro.size(), 5001U);
  ASSERT_EQ(telemetry.sun.size(), 4001U);
  ASSERT_EQ(telemetry.stars.size(), 3001U);
  EXPECT_EQ(telemetry.gyro[3].t, shifted(kStart, 0.3));
  EXPECT_EQ(telemetry.sun.front().t, shifted(kStart, 100.0));
  EXPECT_EQ(telemetry.stars.back().t, shifted(kStart, 500.0));
  EXPECT_EQ(telemetry.missing, 0);
}

TEST(ThreeAxisTelemetry, IsOffByBiasAndNoise) {
  const BodyMotion motion = turning();
  const ThreeAxisSensors said = sensors();
  const ThreeAxisTelemetry telemetry = sent(said, {});
  double gyro = 0.0;
  for (const GyroSample& sample : telemetry.gyro) {
    const Vector3d truth = motion.at(seconds_between(kStart, sample.t)).rate_body_rad_s;
    gyro += ((sample.rate_body_rad_s - said.gyro->bias_rad_s - truth) / kNoise).squaredNorm();
  }
  expect_one(gyro, 3.0 * 5001.0);
  double stars = 0.0;
  for (const StarFix& fix : telemetry.stars) {
    const auto truth = motion.at(seconds_between(kStart, fix.t)).q_icrf_body;
    stars += std::pow(
        angle_between_rad(truth * said.star_tracker->q_body_sensor, fix.q_icrf_sensor) / kNoise, 2);
  }
  expect_one(stars, 3.0 * 3001.0);
  double suns = 0.0;
  for (const SunDirection& sun : telemetry.sun) {
    const Vector3d truth = motion.at(seconds_between(kStart, sun.t)).q_icrf_body.conjugate() *
                           ApparentSun{}.direction_icrf(sun.t, kOrbit.at(sun.t).value());
    suns += std::pow(angle_between_rad(truth, sun.sun_body) / kNoise, 2);
    EXPECT_NEAR(sun.sun_body.norm(), 1.0, 1e-12);
  }
  expect_one(suns, 2.0 * 4001.0);
}

TEST(ThreeAxisTelemetry, OfAMagnetometerIsTheFieldWithBiasAndNoise) {
  constexpr double kNoise_nt = 50.0;
  const Vector3d bias_nt{100.0, -200.0, 300.0};
  ThreeAxisSensors with_field = sensors();
  with_field.magnetometer = TrueMagnetometer{
      .sampling = {150.0, 0.1}, .noise_nt = kNoise_nt, .bias_nt = bias_nt, .field = igrf().value()};
  const ThreeAxisTelemetry telemetry = sent(with_field, {});
  ASSERT_EQ(telemetry.fields.size(), 3501U);
  EXPECT_EQ(telemetry.fields.front().t, shifted(kStart, 150.0));
  const BodyMotion motion = turning();
  TurningEarth earth;
  double squares = 0.0;
  for (const MagneticField& sample : telemetry.fields) {
    const Vector3d true_icrf_nt =
        field_icrf_nt(igrf().value(), sample.t, kOrbit.at(sample.t).value().position_icrf_km, earth)
            .value();
    const Vector3d truth =
        motion.at(seconds_between(kStart, sample.t)).q_icrf_body.conjugate() * true_icrf_nt;
    squares += ((sample.field_body_nt - bias_nt - truth) / kNoise_nt).squaredNorm();
  }
  expect_one(squares, 3.0 * 3501.0);
  // The other samples must not depend on the magnetometer.
  const ThreeAxisTelemetry without = sent(sensors(), {});
  EXPECT_TRUE(without.fields.empty());
  EXPECT_EQ(telemetry.sun.back().sun_body, without.sun.back().sun_body);
  EXPECT_EQ(telemetry.gyro.back().rate_body_rad_s, without.gyro.back().rate_body_rad_s);
}

TEST(ThreeAxisTelemetry, OfAMagnetometerNeedsTheFieldsModel) {
  ThreeAxisSensors with_field = sensors();
  with_field.magnetometer = TrueMagnetometer{.sampling = {0.0, 100.0},
                                             .noise_nt = 1.0,
                                             .bias_nt = Vector3d::Zero(),
                                             .field = igrf().value()};
  Chance chance{7};
  EXPECT_THAT(
      three_axis_telemetry(turning(), instant_of_year(2030.0), with_field, {}, kOrbit, chance),
      IsRefused(ErrorCode::NoCoverage, _));
}

TEST(ThreeAxisTelemetry, OfAGyroStopsAtItsRange) {
  ThreeAxisSensors narrow = sensors();
  narrow.gyro->range_rad_s = 0.012;
  const ThreeAxisTelemetry telemetry = sent(narrow, {});
  const auto stopped = std::ranges::count_if(telemetry.gyro, [](const GyroSample& sample) {
    EXPECT_LE(sample.rate_body_rad_s.cwiseAbs().maxCoeff(), 0.012);
    return sample.rate_body_rad_s.x() == 0.012;
  });
  // The bias alone reaches the range limit.
  EXPECT_GT(stopped, 2000);
}

TEST(ThreeAxisTelemetry, ComesInStepsOfTheResolutionFromSensorsThatAreTurned) {
  constexpr double kStep_rad_s = 1e-3;
  constexpr double kStep = 1e-2;
  const Vector3d misalignment_rad{0.02, -0.01, 0.03};
  ThreeAxisSensors rough = sensors();
  rough.gyro->resolution_rad_s = kStep_rad_s;
  rough.sun_sensor->noise_rad = 0.0;
  rough.sun_sensor->misalignment_rad = misalignment_rad;
  const ThreeAxisTelemetry telemetry = sent(rough, {});
  const ThreeAxisTelemetry fine = sent(sensors(), {});
  for (std::size_t i = 0; i < telemetry.gyro.size(); ++i) {
    const Vector3d steps = telemetry.gyro[i].rate_body_rad_s / kStep_rad_s;
    EXPECT_LT((steps - Vector3d{steps.array().round()}).norm(), 1e-9);
    EXPECT_LE((telemetry.gyro[i].rate_body_rad_s - fine.gyro[i].rate_body_rad_s)
                  .lpNorm<Eigen::Infinity>(),
              0.5001 * kStep_rad_s);
  }
  const BodyMotion motion = turning();
  const auto truth_of = [&](const SunDirection& sun) {
    return Vector3d{motion.at(seconds_between(kStart, sun.t)).q_icrf_body.conjugate() *
                    ApparentSun{}.direction_icrf(sun.t, kOrbit.at(sun.t).value())};
  };
  for (const SunDirection& sun : telemetry.sun) {
    EXPECT_LT((quaternion_by(misalignment_rad) * sun.sun_body - truth_of(sun)).norm(), 1e-12);
  }
  rough.sun_sensor->misalignment_rad.setZero();
  rough.sun_sensor->resolution = kStep;
  for (const SunDirection& sun : sent(rough, {}).sun) {
    EXPECT_NEAR(sun.sun_body.norm(), 1.0, 1e-12);
    EXPECT_LT((sun.sun_body - truth_of(sun)).norm(), std::sqrt(3.0) * kStep);
  }
}

TEST(ThreeAxisTelemetry, LosesSamplesAndLeavesAllOthersAsTheyWere) {
  const ThreeAxisTelemetry whole = sent(sensors(), {});
  const ThreeAxisTelemetry some =
      sent(sensors(), {.lost = 0.2, .silences = {{.from_s = 300.0, .to_s = 310.0}}});
  const auto got = static_cast<double>(some.gyro.size() + some.sun.size() + some.stars.size());
  EXPECT_EQ(static_cast<std::int64_t>(got) + some.missing, 5001 + 4001 + 3001);
  EXPECT_NEAR(got, 0.8 * (12003 - 300), 5.0 * std::sqrt(12003 * 0.2 * 0.8));
  for (const GyroSample& sample : some.gyro) {
    const auto i = static_cast<std::size_t>(std::llround(seconds_between(kStart, sample.t) / 0.1));
    ASSERT_EQ(sample.rate_body_rad_s, whole.gyro[i].rate_body_rad_s);
    ASSERT_FALSE(i >= 3000 && i < 3100);
  }
}

TEST(ThreeAxisTelemetry, HasGapsOfTheGyroAlone) {
  const ThreeAxisTelemetry telemetry =
      sent(sensors(), {.gyro_gaps = {{.from_s = 300.0, .to_s = 310.0}}});
  EXPECT_EQ(telemetry.gyro.size(), 4901U);
  EXPECT_EQ(telemetry.sun.size(), 4001U);
  EXPECT_EQ(telemetry.missing, 0);
}

TEST(ThreeAxisTelemetry, NamesItsSunOutliers) {
  const double off_rad = 20.0 * kRadPerDeg;
  const ThreeAxisTelemetry clean = sent(sensors(), {});
  const ThreeAxisTelemetry dirty =
      sent(sensors(), {.sun_outlier = 0.1, .sun_outlier_rad = off_rad});
  EXPECT_NEAR(static_cast<double>(dirty.sun_outliers.size()), 400.0, 5.0 * std::sqrt(360.0));
  for (std::size_t i = 0; i < dirty.sun.size(); ++i) {
    const bool is_named =
        std::binary_search(dirty.sun_outliers.begin(), dirty.sun_outliers.end(), dirty.sun[i].t);
    ASSERT_NEAR(angle_between_rad(dirty.sun[i].sun_body, clean.sun[i].sun_body),
                is_named ? off_rad : 0.0, 5.0 * kNoise);
  }
}

TEST(ThreeAxisTelemetry, HasNoSunOutOfViewOrInTheShadow) {
  ThreeAxisSensors narrow = sensors();
  narrow.sun_sensor->half_cone_rad = 60.0 * kRadPerDeg;
  const ThreeAxisTelemetry telemetry = sent(narrow, {});
  EXPECT_LT(telemetry.sun.size(), 4001U);
  EXPECT_EQ(telemetry.missing, 0);
  for (const SunDirection& sun : telemetry.sun) {
    EXPECT_LT(angle_between_rad(sun.sun_body, -Vector3d::UnitZ()),
              narrow.sun_sensor->half_cone_rad + 5.0 * kNoise);
  }
  EXPECT_TRUE(sent(sensors(), {}, testing::low_orbit(kStart, 160.0 * kRadPerDeg)).sun.empty());
}

}  // namespace spindrift::three_axis_telemetry_test
