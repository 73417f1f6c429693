#include "pipelines/ground_model/comparison/three_axis_comparison.h"

#include <cmath>
#include <map>
#include <memory>
#include <string>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/rotation_vector.h"
#include "pipelines/ground_model/comparison/model_comparison.h"
#include "services/mission/igrf.h"
#include "tests/support/departures.h"
#include "tests/support/low_orbit.h"
#include "tests/support/matchers.h"

namespace spindrift::testing::three_axis_comparison_test {

using Eigen::Vector3d;

constexpr TaiTime kStart = tai_from_ns(1'772'337'637'000'000'000);
constexpr double kEnd_s = 400.0;
constexpr double kChange_s = 200.0;
constexpr double kGyro_deg_s = 0.002;

/// Stays in sunlight during the motion.
const Orbit kOrbit = low_orbit(kStart);

TumblingScenario scenario(std::uint64_t seed) {
  const ThreeAxisSensors sensors{
      .gyro = TrueGyro{.sampling = {0.0, 0.25},
                       .noise_rad_s = kGyro_deg_s * kRadPerDeg,
                       .bias_rad_s = Vector3d::Zero(),
                       .range_rad_s = std::nullopt},
      .sun_sensor =
          TrueSunSensor{
              .sampling = {0.0, 1.0}, .noise_rad = 0.5 * kRadPerDeg, .half_cone_rad = kTurn_rad},
      .star_tracker =
          TrueStarTracker{.sampling = {0.0, 1.0},
                          .noise_rad = 20.0 / 3600.0 * kRadPerDeg,
                          .q_body_sensor = Eigen::Quaterniond{0.5, -0.5, 0.1, 0.7}.normalized()},
      .magnetometer = TrueMagnetometer{.sampling = {0.0, 1.0},
                                       .noise_nt = 100.0,
                                       .bias_nt = {50.0, 0.0, -80.0},
                                       .field = igrf().value()}};
  return {.view = {.seed = seed,
                   .sensors = sensors,
                   .bias_sigma_rad_s = 0.0,
                   .bias_rad_s = Vector3d{1e-4, -2e-4, 3e-4},
                   .faults = {.lost = 0.01}},
          .truth = {.body = {.start = kStart,
                             .at_start = {.q_icrf_body = quaternion_by({2.0, -1.0, 0.5}),
                                          .rate_body_rad_s = kRadPerDeg * Vector3d{0.5, -0.2, 0.3}},
                             .inertia_kg_m2 = Vector3d{16.0, 18.0, 12.0}.asDiagonal(),
                             .end_s = kEnd_s}}};
}

ThreeAxisTelemetry flight(std::uint64_t seed = 1) {
  return flown(scenario(seed), kOrbit).value().telemetry;
}

/// Compares the samples kind by kind; the kinds overlap in time.
ByChannel compared(const ThreeAxisTelemetry& flight) {
  static const auto model =
      std::make_shared<const GroundModel>(three_axis_model(scenario(99), kOrbit).value());
  ModelComparison comparison{model, 5.0};
  using Sample = std::variant<GyroSample, SunDirection, StarFix, MagneticField>;
  std::vector<Sample> all{flight.gyro.begin(), flight.gyro.end()};
  all.insert(all.end(), flight.sun.begin(), flight.sun.end());
  all.insert(all.end(), flight.stars.begin(), flight.stars.end());
  all.insert(all.end(), flight.fields.begin(), flight.fields.end());
  const auto time_of = [](const Sample& sample) {
    return std::visit([](const auto& is) { return is.t; }, sample);
  };
  std::ranges::stable_sort(
      all, [&](const Sample& a, const Sample& b) { return time_of(a) < time_of(b); });
  for (const Sample& sample : all) {
    std::visit([&](const auto& is) { comparison.compare(is); }, sample);
  }
  return by_channel(comparison.channels());
}

std::map<std::string, double> departures_s(const ByChannel& all) {
  return testing::departures_s(all, kStart);
}

void expect_only(const ThreeAxisTelemetry& flight, const std::string& channel, double within_s) {
  testing::expect_only(departures_s(compared(flight)), channel, {kChange_s, kChange_s + within_s});
}

bool is_after_change(TaiTime t) { return seconds_between(kStart, t) >= kChange_s; }

TEST(ThreeAxisComparison, IsOfUnitVarianceInTheModelsOwnPasses) {
  std::map<std::string, double> squares;
  std::map<std::string, double> counts;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    for (const auto& [name, channel] : compared(flight(seed))) {
      EXPECT_FALSE(channel.departure) << name << " of seed " << seed;
      const auto count = static_cast<double>(channel.residuals.count());
      squares[name] += count * std::pow(channel.residuals.normalised_rms(), 2);
      counts[name] += count;
    }
  }
  ASSERT_EQ(counts.size(), 4U + 11U);
  for (const auto& [name, count] : counts) {
    if (name.find('_') != std::string::npos) {
      EXPECT_GT(count, 20 * 390) << name;
      EXPECT_NEAR(squares[name] / count, 1.0, 5.0 * std::sqrt(2.0 / count)) << name;
    }
  }
}

TEST(ThreeAxisComparison, FindsABiasOfTheGyro) {
  ThreeAxisTelemetry biased = flight();
  for (GyroSample& sample : biased.gyro) {
    sample.rate_body_rad_s.y() += is_after_change(sample.t) ? 0.02 * kRadPerDeg : 0.0;
  }
  expect_only(biased, "gyro_y", 0.25);
  const Evidence departure = *compared(biased).at("gyro_y").departure;
  EXPECT_NEAR(departure.value, 0.02, 5.0 * kGyro_deg_s);
  EXPECT_NEAR(departure.limit, 5.0 * kGyro_deg_s, 1e-12);
}

TEST(ThreeAxisComparison, FindsABiasOfTheMagnetometer) {
  ThreeAxisTelemetry biased = flight();
  for (MagneticField& field : biased.fields) {
    field.field_body_nt.z() -= is_after_change(field.t) ? 1000.0 : 0.0;
  }
  expect_only(biased, "magnetometer_z", 1.0);
}

/// A stuck thruster gives a torque about X: the rate leaves its band when the torque has changed it
/// by five sigma, the attitude when the body has rotated by five sigma of the tracker.
TEST(ThreeAxisComparison, FindsAThrusterThatIsStuck) {
  constexpr double kTorque_nm = 2e-5;
  const double acceleration_deg_s2 = kDegPerRad * kTorque_nm / 16.0;
  const TumblingScenario plan = scenario(1);
  BodyMotion motion{RigidBody::make(plan.truth.body.inertia_kg_m2).value(),
                    plan.truth.body.at_start, 0.1};
  for (int i = 0; i < 4000; ++i) {
    motion.step({.external_nm = {i >= 2000 ? kTorque_nm : 0.0, 0.0, 0.0}});
  }
  Chance chance{7};
  ThreeAxisSensors sensors = plan.view.sensors;
  sensors.gyro->bias_rad_s = *plan.view.bias_rad_s;
  const auto departed = departures_s(compared(
      three_axis_telemetry(motion, kStart, sensors, plan.view.faults, kOrbit, chance).value()));
  const double rate_s = 5.0 * kGyro_deg_s / acceleration_deg_s2;
  const double attitude_s = std::sqrt(2.0 * 5.0 * 20.0 / 3600.0 / acceleration_deg_s2);
  ASSERT_TRUE(departed.contains("gyro_x") && departed.contains("star_x"));
  EXPECT_NEAR(departed.at("gyro_x"), kChange_s + rate_s, 0.5 * rate_s);
  EXPECT_NEAR(departed.at("star_x"), kChange_s + attitude_s, 0.3 * attitude_s);
  EXPECT_FALSE(departed.contains("gyro") || departed.contains("star"));
}

TEST(ThreeAxisComparison, FindsTheSensorThatDies) {
  ThreeAxisTelemetry dead = flight();
  std::erase_if(dead.stars, [](const StarFix& fix) { return is_after_change(fix.t); });
  expect_only(dead, "star", 2.0);
  EXPECT_EQ(compared(dead).at("star").departure->unit, "s silent");
  dead = flight();
  std::erase_if(dead.gyro, [](const GyroSample& sample) { return is_after_change(sample.t); });
  expect_only(dead, "gyro", 2.0);
}

TEST(ThreeAxisComparison, FindsASensorThatNeverCame) {
  ThreeAxisTelemetry dead = flight();
  dead.sun.clear();
  const auto departed = departures_s(compared(dead));
  ASSERT_EQ(departed.size(), 1U) << ::testing::PrintToString(departed);
  EXPECT_LT(departed.at("sun"), 3.0);
}

/// Samples are not missing while the sensor cannot see the Sun or in a gap of the gyro.
TEST(ThreeAxisComparison, MissesNothingThatTheModelDoesNotSend) {
  TumblingScenario plan = scenario(4);
  plan.view.sensors.sun_sensor->half_cone_rad = 40.0 * kRadPerDeg;
  plan.view.faults.gyro_gaps = {{.from_s = 100.0, .to_s = 150.0}};
  const auto model = std::make_shared<const GroundModel>(three_axis_model(plan, kOrbit).value());
  const ThreeAxisTelemetry sent = flown(plan, kOrbit).value().telemetry;
  ASSERT_LT(sent.sun.size(), 350U);
  ModelComparison comparison{model, 5.0};
  std::size_t gyro = 0;
  std::size_t sun = 0;
  for (const MagneticField& field : sent.fields) {
    for (; gyro < sent.gyro.size() && sent.gyro[gyro].t < field.t; ++gyro) {
      comparison.compare(sent.gyro[gyro]);
    }
    for (; sun < sent.sun.size() && sent.sun[sun].t < field.t; ++sun) {
      comparison.compare(sent.sun[sun]);
    }
    comparison.compare(field);
  }
  for (const ChannelComparison& channel : comparison.channels()) {
    EXPECT_EQ(channel.departure.has_value(), channel.channel.name == "star")
        << channel.channel.name;
  }
}

TEST(ThreeAxisComparison, RefusesASensorWithoutNoise) {
  TumblingScenario plan = scenario(1);
  plan.view.sensors.sun_sensor->noise_rad = 0.0;
  EXPECT_THAT(three_axis_model(plan, kOrbit), IsRefused(ErrorCode::InvalidConfiguration, _));
}

}  // namespace spindrift::testing::three_axis_comparison_test
