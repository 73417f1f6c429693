#include "services/mission/mission_three_axis.h"

#include <vector>

#include "services/mission/values.h"

namespace spindrift {
namespace {

std::optional<GyroSensor> gyro(const TomlValues& values) {
  if (!values.contains("three_axis.gyro.noise_deg_s")) {
    return std::nullopt;
  }
  return GyroSensor{.noise_rad_s = radians(values, "three_axis.gyro.noise_deg_s"),
                    .bias_sigma_rad_s = radians(values, "three_axis.gyro.bias_sigma_deg_s"),
                    .range_rad_s = radians_if(values, "three_axis.gyro.range_deg_s")};
}

std::optional<DigitalSunSensor> sun_sensor(const TomlValues& values) {
  const auto noise_rad = radians_if(values, "three_axis.sun_sensor.noise_deg");
  return noise_rad ? std::optional{DigitalSunSensor{*noise_rad}} : std::nullopt;
}

std::optional<StarTracker> star_tracker(const TomlValues& values) {
  const auto q = value_if<std::vector<double>>(values, "three_axis.star_tracker.q_body_sensor");
  if (!q) {
    return std::nullopt;
  }
  const Eigen::Quaterniond q_body_sensor{q->at(3), q->at(0), q->at(1), q->at(2)};
  return StarTracker{
      .q_body_sensor = q_body_sensor.normalized(),
      .noise_rad = radians(values, "three_axis.star_tracker.noise_arcsec") / kArcsecPerDeg};
}

std::optional<Magnetometer> magnetometer(const TomlValues& values) {
  const auto noise_nt = value_if<double>(values, "three_axis.magnetometer.noise_nt");
  return noise_nt ? std::optional{Magnetometer{*noise_nt}} : std::nullopt;
}

std::optional<Inertia> inertia(const TomlValues& values) {
  const auto kg_m2 = value_if<std::vector<double>>(values, "three_axis.inertia.kg_m2");
  if (!kg_m2) {
    return std::nullopt;
  }
  // The matrix is symmetric, so row or column order is the same.
  return Inertia{.kg_m2 = Eigen::Map<const Eigen::Matrix3d>{kg_m2->data()},
                 .sigma_fraction = number(values, "three_axis.inertia.sigma_fraction")};
}

}  // namespace

ThreeAxisConfig three_axis_config(const TomlValues& values) {
  return {.gyro = gyro(values),
          .sun_sensor = sun_sensor(values),
          .star_tracker = star_tracker(values),
          .magnetometer = magnetometer(values),
          .inertia = inertia(values)};
}

}  // namespace spindrift
