#include "tests/support/separation_flight.h"

#include <utility>

#include "pipelines/ephemeris/kepler_orbit.h"
#include "pipelines/frames/angle.h"
#include "pipelines/frames/rotation_vector.h"
#include "pipelines/ground_model/flights/three_axis_flights.h"
#include "pipelines/ground_model/link/chance.h"
#include "pipelines/ground_model/link/three_axis_telemetry.h"

namespace spindrift::testing {
namespace {

using Eigen::Vector3d;

const TaiTime kSeparation = tai_from_ns(1'772'337'637'000'000'000);
const Vector3d kMoments_kg_m2{120.0, 100.0, 140.0};

ThreeAxisConfig sensors_of(const FlightPlan& plan) {
  return {.gyro = GyroSensor{.noise_rad_s = plan.gyro_noise_deg_s * kRadPerDeg,
                             .bias_sigma_rad_s = plan.bias_sigma_deg_s * kRadPerDeg,
                             .range_rad_s = std::nullopt},
          .sun_sensor = DigitalSunSensor{plan.sun_noise_deg * kRadPerDeg},
          .star_tracker = StarTracker{Eigen::Quaterniond{0.876, 0.192, -0.096, 0.431}.normalized(),
                                      plan.star_noise_arcsec / 3600.0 * kRadPerDeg},
          .magnetometer = std::nullopt,
          .inertia = Inertia{kMoments_kg_m2.asDiagonal(), 0.0}};
}

Orbit along_the_terminator() {
  return Orbit{KeplerOrbit::make({.epoch = kSeparation,
                                  .semi_major_axis_km = 7500.0,
                                  .eccentricity = 0.0,
                                  .inclination_rad = 98.0 * kRadPerDeg,
                                  .raan_rad = 72.0 * kRadPerDeg,
                                  .argument_of_perigee_rad = 0.0,
                                  .mean_anomaly_rad = 0.0})
                   .value()};
}

SeparationTruth truth_of(const FlightPlan& plan, Chance& chance) {
  const Vector3d turn_rad = chance.normal_vector(2.0);
  const Vector3d rate_deg_s = chance.normal_vector(0.35) + Vector3d{0.3, -0.2, 0.05};
  return {.body = {.start = kSeparation,
                   .at_start = {.q_icrf_body = quaternion_by(turn_rad),
                                .rate_body_rad_s = rate_deg_s * kRadPerDeg},
                   .inertia_kg_m2 = kMoments_kg_m2.asDiagonal(),
                   .end_s = plan.end_s},
          .control = {.thrusters = {.torque_nm = 0.08, .shortest_s = 0.01, .longest_s = 1.0},
                      .dead_band_rad_s = 0.03 * kRadPerDeg,
                      .slew_rad_s = 0.5 * kRadPerDeg},
          .control_on_s = plan.control_on_s,
          .acquisition_s = plan.acquisition_s};
}

ThreeAxisSensors true_sensors(const FlightPlan& plan, const ThreeAxisConfig& said,
                              const Vector3d& bias_rad_s) {
  const double star_step_s = plan.star_fix_step_s > 0.0 ? plan.star_fix_step_s : 2.0 * plan.end_s;
  return {.gyro = TrueGyro{.sampling = {plan.control_on_s, plan.gyro_step_s},
                           .noise_rad_s = said.gyro->noise_rad_s,
                           .bias_rad_s = bias_rad_s,
                           .range_rad_s = std::nullopt},
          .sun_sensor = TrueSunSensor{.sampling = {plan.acquisition_s, plan.sun_step_s},
                                      .noise_rad = said.sun_sensor->noise_rad,
                                      .half_cone_rad = kTurn_rad},
          .star_tracker = TrueStarTracker{.sampling = {plan.first_star_fix_s, star_step_s},
                                          .noise_rad = said.star_tracker->noise_rad,
                                          .q_body_sensor = said.star_tracker->q_body_sensor}};
}

}  // namespace

Vector3d SeparationFlight::error_rad(std::size_t event, const Eigen::Quaterniond& found) const {
  return rotation_vector_of(found.conjugate() * Eigen::Quaterniond{R_icrf_body[event]});
}

SeparationFlight separation_flight(const FlightPlan& plan, std::uint64_t seed) {
  Chance chance{seed};
  const ThreeAxisConfig sensors = sensors_of(plan);
  const SeparationTruth truth = truth_of(plan, chance);
  const Vector3d bias_rad_s = chance.normal_vector(sensors.gyro->bias_sigma_rad_s);
  const Orbit orbit = along_the_terminator();
  const BodyMotion motion = separation_motion(truth, orbit).value();
  ThreeAxisTelemetry telemetry =
      three_axis_telemetry(motion, kSeparation, true_sensors(plan, sensors, bias_rad_s), {}, orbit,
                           chance)
          .value();
  const auto at = [](double t_s) { return shifted(kSeparation, t_s); };
  SeparationFlight flight{
      .sensors = sensors,
      .times = {at(0.0), at(plan.control_on_s), at(plan.acquisition_s), at(plan.first_star_fix_s)},
      .gyro = std::move(telemetry.gyro),
      .sun = std::move(telemetry.sun),
      .stars = std::move(telemetry.stars),
      .bias_rad_s = bias_rad_s,
      .orbit = orbit,
      .R_icrf_body = {}};
  for (const double t_s : {0.0, plan.control_on_s, plan.acquisition_s, plan.first_star_fix_s}) {
    flight.R_icrf_body.push_back(motion.at(t_s).q_icrf_body.toRotationMatrix());
  }
  return flight;
}

}  // namespace spindrift::testing
