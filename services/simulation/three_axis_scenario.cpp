#include "services/simulation/three_axis_scenario.h"

#include <fmt/format.h>

#include <cstdint>
#include <limits>
#include <vector>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/euler312.h"
#include "pipelines/frames/inertia.h"
#include "pipelines/frames/rotation_vector.h"
#include "pipelines/ground_model/control/actuators.h"
#include "services/mission/igrf.h"
#include "services/mission/mission_three_axis.h"
#include "services/mission/values.h"
#include "services/simulation/silences.h"

namespace spindrift {
namespace {

using Eigen::Vector3d;

Sampling sampling_of(const TomlValues& values, double from_s, std::string_view step) {
  return {.from_s = from_s, .step_s = number(values, step)};
}

std::optional<TrueGyro> gyro_of(const TomlValues& values, const std::optional<GyroSensor>& said,
                                double from_s) {
  if (!said) {
    return std::nullopt;
  }
  return TrueGyro{
      .sampling = sampling_of(values, from_s, "telemetry.gyro_step_s"),
      .noise_rad_s = radians_if(values, "truth.gyro.noise_deg_s").value_or(said->noise_rad_s),
      .bias_rad_s = Vector3d::Zero(),
      .range_rad_s = said->range_rad_s,
      .resolution_rad_s = radians(values, "truth.gyro.resolution_deg_s")};
}

std::optional<TrueSunSensor> sun_sensor_of(const TomlValues& values,
                                           const std::optional<DigitalSunSensor>& said,
                                           double from_s) {
  if (!said) {
    return std::nullopt;
  }
  return TrueSunSensor{
      .sampling = sampling_of(values, from_s, "telemetry.sun_step_s"),
      .noise_rad = radians_if(values, "truth.sun_sensor.noise_deg").value_or(said->noise_rad),
      .half_cone_rad = radians(values, "truth.sun_sensor.half_cone_deg"),
      .misalignment_rad =
          radians_vector_if(values, "truth.sun_sensor.misalignment_deg").value_or(Vector3d::Zero()),
      .resolution = number(values, "truth.sun_sensor.resolution")};
}

std::optional<TrueStarTracker> star_tracker_of(const TomlValues& values,
                                               const std::optional<StarTracker>& said,
                                               double from_s) {
  if (!said) {
    return std::nullopt;
  }
  const auto noise_arcsec = value_if<double>(values, "truth.star_tracker.noise_arcsec");
  return TrueStarTracker{
      .sampling = sampling_of(values, from_s, "telemetry.star_step_s"),
      .noise_rad = noise_arcsec ? *noise_arcsec / kArcsecPerDeg * kRadPerDeg : said->noise_rad,
      .q_body_sensor =
          said->q_body_sensor *
          quaternion_by(radians_vector_if(values, "truth.star_tracker.misalignment_deg")
                            .value_or(Vector3d::Zero()))};
}

std::optional<TrueMagnetometer> magnetometer_of(const TomlValues& values,
                                                const std::optional<Magnetometer>& said,
                                                double from_s) {
  if (!said) {
    return std::nullopt;
  }
  return TrueMagnetometer{
      .sampling = sampling_of(values, from_s, "telemetry.magnetometer_step_s"),
      .noise_nt = value_if<double>(values, "truth.magnetometer.noise_nt").value_or(said->noise_nt),
      .bias_nt = vector_or_zero(values, "truth.magnetometer.bias_nt"),
      .field = igrf().value(),
      .resolution_nt = number(values, "truth.magnetometer.resolution_nt")};
}

PeriodicTorque periodic_of(const TomlValues& values) {
  const auto amplitude_nm = vector_if(values, "disturbances.periodic.amplitude_nm");
  return amplitude_nm
             ? PeriodicTorque{.amplitude_body_nm = *amplitude_nm,
                              .rate_rad_s =
                                  kTurn_rad / number(values, "disturbances.periodic.period_s"),
                              .phase_rad = radians(values, "disturbances.periodic.phase_deg")}
             : PeriodicTorque{};
}

std::optional<Drag> drag_of(const TomlValues& values) {
  const auto density_kg_m3 = value_if<double>(values, "disturbances.drag.density_kg_m3");
  if (!density_kg_m3) {
    return std::nullopt;
  }
  return Drag{
      .atmosphere = {.density_kg_m3 = *density_kg_m3,
                     .altitude_km = number(values, "disturbances.drag.altitude_km"),
                     .scale_height_km =
                         value_if<double>(values, "disturbances.drag.scale_height_km")
                             .value_or(std::numeric_limits<double>::infinity())},
      .area_m2 = number(values, "disturbances.drag.area_m2"),
      .coefficient = number(values, "disturbances.drag.coefficient"),
      .centre_of_pressure_body_m = *vector_if(values, "disturbances.drag.centre_of_pressure_m")};
}

Disturbances disturbances_of(const TomlValues& values) {
  return {.gravity_gradient = value_of<bool>(values, "disturbances.gravity_gradient"),
          .drag = drag_of(values),
          .dipole_body_a_m2 = vector_or_zero(values, "disturbances.dipole_a_m2"),
          .constant_body_nm = vector_or_zero(values, "disturbances.constant_nm"),
          .periodic = periodic_of(values)};
}

}  // namespace

std::optional<Vector3d> vector_if(const TomlValues& values, std::string_view key) {
  const auto elements = value_if<std::vector<double>>(values, key);
  return elements ? std::optional<Vector3d>{Vector3d{elements->data()}} : std::nullopt;
}

Vector3d vector_or_zero(const TomlValues& values, std::string_view key) {
  return vector_if(values, key).value_or(Vector3d::Zero());
}

std::optional<Vector3d> radians_vector_if(const TomlValues& values, std::string_view key) {
  const auto deg = vector_if(values, key);
  return deg ? std::optional<Vector3d>{kRadPerDeg * *deg} : std::nullopt;
}

ThreeAxisView three_axis_view(const TomlValues& values, const ThreeAxisConfig& said,
                              const FirstSamples& first) {
  return {
      .seed = static_cast<std::uint64_t>(value_of<std::int64_t>(values, "pass.seed")),
      .sensors = {.gyro = gyro_of(values, said.gyro, first.gyro_s),
                  .sun_sensor = sun_sensor_of(values, said.sun_sensor, first.sun_s),
                  .star_tracker = star_tracker_of(values, said.star_tracker, first.star_s),
                  .magnetometer = magnetometer_of(values, said.magnetometer, first.magnetometer_s)},
      .bias_sigma_rad_s = said.gyro ? said.gyro->bias_sigma_rad_s : 0.0,
      .bias_rad_s = radians_vector_if(values, "truth.gyro.bias_deg_s"),
      .faults = {.lost = number(values, "faults.lost"),
                 .sun_outlier = number(values, "faults.sun_outlier"),
                 .sun_outlier_rad = radians(values, "faults.sun_outlier_deg"),
                 .silences = silences_of(values, "faults.silence"),
                 .gyro_gaps = silences_of(values, "faults.gyro_gap")}};
}

BodyTruth body_truth(const TomlValues& values, const ThreeAxisConfig& said, TaiTime start) {
  const Vector3d angles_rad = *radians_vector_if(values, "attitude.euler312_icrf_deg");
  const Disturbances disturbances = disturbances_of(values);
  return {.start = start,
          .at_start = {.q_icrf_body = quaternion_of(Euler312{.phi_rad = angles_rad[0],
                                                             .theta_rad = angles_rad[1],
                                                             .psi_rad = angles_rad[2]}),
                       .rate_body_rad_s = *radians_vector_if(values, "attitude.rate_deg_s")},
          .inertia_kg_m2 = number(values, "truth.inertia.factor") * said.inertia->kg_m2,
          .end_s = number(values, "pass.duration_s"),
          .disturbances = disturbances,
          .field = disturbances.dipole_body_a_m2.isZero() ? std::nullopt
                                                          : std::optional{igrf().value()}};
}

void check_within_pass(TomlDocument& document, std::string_view key) {
  const auto t_s = value_if<double>(document.values, key);
  const auto duration_s = value_if<double>(document.values, "pass.duration_s");
  if (t_s && duration_s && !(*t_s <= *duration_s)) {
    add_problem(
        document, key,
        fmt::format("{} = {}: must not be above pass.duration_s = {}", key, *t_s, *duration_s));
  }
}

void check_sensors_on_board(TomlDocument& document) {
  bool has_any = false;
  for (const char* const sensor : {"gyro", "sun_sensor", "star_tracker", "magnetometer"}) {
    const bool is_on_board{document.table.at_path(fmt::format("three_axis.{}", sensor))};
    has_any = has_any || is_on_board;
    const std::string truth = fmt::format("truth.{}", sensor);
    if (!is_on_board && document.table.at_path(truth)) {
      add_problem(document, truth,
                  fmt::format("[{}]: there is no [three_axis.{}] that it could differ from", truth,
                              sensor));
    }
  }
  if (!has_any) {
    add_problem(document, "three_axis",
                "[three_axis]: must have gyro, sun_sensor, star_tracker or magnetometer");
  }
}

void check_body_step(TomlDocument& document, std::string_view key) {
  const auto period_s = value_if<double>(document.values, key);
  const auto rate_rad_s = radians_vector_if(document.values, "attitude.rate_deg_s");
  const auto kg_m2 = value_if<std::vector<double>>(document.values, "three_axis.inertia.kg_m2");
  if (!period_s || !rate_rad_s || !kg_m2) {
    return;
  }
  const BodyTruth body{
      .start = {},
      .at_start = {.q_icrf_body = Eigen::Quaterniond::Identity(), .rate_body_rad_s = *rate_rad_s},
      .inertia_kg_m2 = Eigen::Map<const Eigen::Matrix3d>{kg_m2->data()},
      .end_s = 0.0};
  if (const auto loop = loop_of(body, HeldMomentum{}, *period_s); !loop) {
    add_problem(document, key, fmt::format("{} = {}: {}", key, *period_s, loop.error().message));
  }
}

void check_tumbling_scenario(TomlDocument& document) {
  check_within_pass(document, "tumbling.first_star_fix_s");
  check_sensors_on_board(document);
}

TumblingScenario tumbling_scenario(const TomlValues& values, TaiTime start) {
  const ThreeAxisConfig said = three_axis_config(values);
  return {.view = three_axis_view(values, said,
                                  {.star_s = number(values, "tumbling.first_star_fix_s")}),
          .truth = {.body = body_truth(values, said, start),
                    .wheels_body_nms = vector_or_zero(values, "tumbling.wheels_nms")}};
}

}  // namespace spindrift
