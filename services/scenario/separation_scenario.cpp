#include "services/scenario/separation_scenario.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <vector>

#include "pipelines/frames/euler312.h"
#include "services/geomagnetism/igrf.h"
#include "services/mission/mission_three_axis.h"
#include "services/scenario/silences.h"
#include "services/toml_schema/values.h"
#include "services/units/degrees.h"

namespace spindrift {
namespace {

constexpr double kArcsecPerDeg = 3600.0;

Eigen::Vector3d vector_of(const std::vector<double>& elements) {
  return Eigen::Vector3d{elements.data()};
}

/// Of a key in degrees; empty where it is absent.
std::optional<Eigen::Vector3d> radians_vector_if(const TomlValues& values, std::string_view key) {
  const auto deg = value_if<std::vector<double>>(values, key);
  return deg ? std::optional<Eigen::Vector3d>{kRadPerDeg * vector_of(*deg)} : std::nullopt;
}

Eigen::Vector3d radians_vector(const TomlValues& values, std::string_view key) {
  return *radians_vector_if(values, key);
}

SeparationTruth truth_of(const TomlValues& values, const Eigen::Matrix3d& inertia_kg_m2,
                         TaiTime start) {
  const Eigen::Vector3d angles_rad = radians_vector(values, "attitude.euler312_icrf_deg");
  return {.separation = start,
          .at_separation = {.q_icrf_body = quaternion_of(Euler312{.phi_rad = angles_rad[0],
                                                                  .theta_rad = angles_rad[1],
                                                                  .psi_rad = angles_rad[2]}),
                            .rate_body_rad_s = radians_vector(values, "attitude.rate_deg_s")},
          .inertia_kg_m2 = inertia_kg_m2,
          .control = {.thrusters = {.torque_nm = number(values, "control.torque_nm"),
                                    .shortest_s = number(values, "control.shortest_pulse_s"),
                                    .longest_s = number(values, "control.longest_pulse_s")},
                      .dead_band_rad_s = radians(values, "control.dead_band_deg_s"),
                      .slew_rad_s = radians(values, "control.slew_deg_s"),
                      .period_s = number(values, "control.period_s")},
          .phases = {.control_on_s = number(values, "separation.control_on_s"),
                     .acquisition_s = number(values, "separation.acquisition_s"),
                     .end_s = number(values, "pass.duration_s")}};
}

Sampling sampling_of(const TomlValues& values, std::string_view from, std::string_view step) {
  return {.from_s = number(values, from), .step_s = number(values, step)};
}

std::optional<TrueMagnetometer> magnetometer_of(const TomlValues& values,
                                                const ThreeAxisConfig& said) {
  if (!said.magnetometer) {
    return std::nullopt;
  }
  return TrueMagnetometer{
      .sampling = sampling_of(values, "separation.control_on_s", "telemetry.magnetometer_step_s"),
      .noise_nt = value_if<double>(values, "truth.magnetometer.noise_nt")
                      .value_or(said.magnetometer->noise_nt),
      .bias_nt = vector_of(value_if<std::vector<double>>(values, "truth.magnetometer.bias_nt")
                               .value_or(std::vector<double>(3, 0.0))),
      .field = igrf().value()};
}

ThreeAxisSensors sensors_of(const TomlValues& values, const ThreeAxisConfig& said) {
  const auto sampling = [&](std::string_view from, std::string_view step) {
    return sampling_of(values, from, step);
  };
  const auto star_noise_arcsec = value_if<double>(values, "truth.star_tracker.noise_arcsec");
  return {
      .gyro = {.sampling = sampling("separation.control_on_s", "telemetry.gyro_step_s"),
               .noise_rad_s =
                   radians_if(values, "truth.gyro.noise_deg_s").value_or(said.gyro->noise_rad_s),
               .bias_rad_s = Eigen::Vector3d::Zero(),
               .range_rad_s = said.gyro->range_rad_s},
      .sun_sensor = {.sampling = sampling("separation.acquisition_s", "telemetry.sun_step_s"),
                     .noise_rad = radians_if(values, "truth.sun_sensor.noise_deg")
                                      .value_or(said.sun_sensor->noise_rad),
                     .half_cone_rad = radians(values, "truth.sun_sensor.half_cone_deg")},
      .star_tracker = {.sampling = sampling("separation.first_star_fix_s", "telemetry.star_step_s"),
                       .noise_rad = star_noise_arcsec
                                        ? *star_noise_arcsec / kArcsecPerDeg * kRadPerDeg
                                        : said.star_tracker->noise_rad,
                       .q_body_sensor = said.star_tracker->q_body_sensor},
      .magnetometer = magnetometer_of(values, said)};
}

std::optional<LauncherTelling> launcher_of(const TomlValues& values) {
  const auto sigma_rad = radians_if(values, "separation.launcher.sigma_deg");
  return sigma_rad ? std::optional{LauncherTelling{
                         .sigma_rad = *sigma_rad,
                         .off_rad = radians_vector_if(values, "separation.launcher.off_deg")}}
                   : std::nullopt;
}

void check_star_fix(TomlDocument& document) {
  const auto first_s = value_if<double>(document.values, "separation.first_star_fix_s");
  const auto duration_s = value_if<double>(document.values, "pass.duration_s");
  if (first_s && duration_s && !(*first_s <= *duration_s)) {
    add_problem(
        document, "separation.first_star_fix_s",
        fmt::format("separation.first_star_fix_s = {}: must not be above pass.duration_s = {}",
                    *first_s, *duration_s));
  }
}

/// Stronger ones would throw the body from one end of the band to the other for ever.
void check_relays(TomlDocument& document) {
  const auto torque_nm = value_if<double>(document.values, "control.torque_nm");
  const auto dead_band_deg_s = value_if<double>(document.values, "control.dead_band_deg_s");
  const auto period_s = value_if<double>(document.values, "control.period_s");
  const auto longest_s = value_if<double>(document.values, "control.longest_pulse_s");
  const auto kg_m2 = value_if<std::vector<double>>(document.values, "three_axis.inertia.kg_m2");
  if (!torque_nm || !dead_band_deg_s || !period_s || !longest_s || !kg_m2) {
    return;
  }
  const double on_s = std::min(*period_s, *longest_s);
  const auto body = RigidBody::make(Eigen::Map<const Eigen::Matrix3d>{kg_m2->data()});
  if (!body) {
    return;
  }
  const double change_deg_s =
      body->acceleration_rad_s2(Eigen::Vector3d::Zero(), Eigen::Vector3d::Constant(*torque_nm),
                                Eigen::Vector3d::Zero())
          .cwiseAbs()
          .maxCoeff() *
      on_s * kDegPerRad;
  if (!(change_deg_s <= *dead_band_deg_s)) {
    add_problem(
        document, "control.torque_nm",
        fmt::format("control.torque_nm = {}: changes the rate by {:.3g} deg/s in {} s: must "
                    "not change it by more than control.dead_band_deg_s = {}",
                    *torque_nm, change_deg_s, on_s, *dead_band_deg_s));
  }
}

}  // namespace

void check_separation_scenario(TomlDocument& document) {
  check_star_fix(document);
  check_relays(document);
}

SeparationScenario separation_scenario(const TomlValues& values, TaiTime start) {
  const ThreeAxisConfig said = three_axis_config(values);
  return {.seed = static_cast<std::uint64_t>(value_of<std::int64_t>(values, "pass.seed")),
          .truth = truth_of(values, said.inertia->kg_m2, start),
          .first_star_fix_s = number(values, "separation.first_star_fix_s"),
          .sensors = sensors_of(values, said),
          .bias_sigma_rad_s = said.gyro->bias_sigma_rad_s,
          .bias_rad_s = radians_vector_if(values, "truth.gyro.bias_deg_s"),
          .faults = {.lost = number(values, "faults.lost"),
                     .sun_outlier = number(values, "faults.sun_outlier"),
                     .sun_outlier_rad = radians(values, "faults.sun_outlier_deg"),
                     .silences = silences_of(values, "faults.silence"),
                     .gyro_gaps = silences_of(values, "faults.gyro_gap")},
          .launcher = launcher_of(values)};
}

}  // namespace spindrift
