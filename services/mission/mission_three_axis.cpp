#include "services/mission/mission_three_axis.h"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "services/mission/mission_alignment.h"
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

std::optional<FieldOfView> field_of_view(const TomlValues& values, const std::string& sensor) {
  const auto boresight = value_if<std::vector<double>>(values, sensor + ".boresight_body");
  const auto half_angle_rad = radians_if(values, sensor + ".fov_deg");
  if (!boresight || !half_angle_rad) {
    return std::nullopt;
  }
  return FieldOfView{.boresight_body = Eigen::Vector3d{boresight->data()}.normalized(),
                     .half_angle_rad = *half_angle_rad};
}

std::optional<DigitalSunSensor> sun_sensor(const TomlValues& values) {
  const auto noise_rad = radians_if(values, "three_axis.sun_sensor.noise_deg");
  return noise_rad
             ? std::optional{DigitalSunSensor{
                   .noise_rad = *noise_rad, .view = field_of_view(values, "three_axis.sun_sensor")}}
             : std::nullopt;
}

/// Returns a quaternion of the form "unit_quaternion", of exactly unit length.
std::optional<Eigen::Quaterniond> quaternion_if(const TomlValues& values, const std::string& key) {
  const auto q = value_if<std::vector<double>>(values, key);
  return q ? std::optional{Eigen::Quaterniond{q->at(3), q->at(0), q->at(1), q->at(2)}.normalized()}
           : std::nullopt;
}

std::optional<StarTracker> star_tracker(const TomlValues& values) {
  const auto q_body_sensor = quaternion_if(values, "three_axis.star_tracker.q_body_sensor");
  if (!q_body_sensor) {
    return std::nullopt;
  }
  return StarTracker{
      .q_body_sensor = *q_body_sensor,
      .noise_rad = radians(values, "three_axis.star_tracker.noise_arcsec") / kArcsecPerDeg,
      .view = field_of_view(values, "three_axis.star_tracker")};
}

std::optional<Magnetometer> magnetometer(const TomlValues& values) {
  const auto noise_nt = value_if<double>(values, "three_axis.magnetometer.noise_nt");
  return noise_nt ? std::optional{Magnetometer{*noise_nt}} : std::nullopt;
}

std::optional<Inertia> inertia(const TomlValues& values, const AttitudeAlignment& alignment) {
  const auto kg_m2 = value_if<std::vector<double>>(values, "three_axis.inertia.kg_m2");
  if (!kg_m2) {
    return std::nullopt;
  }
  // The matrix is symmetric, so row or column order is the same.
  return Inertia{.kg_m2 = Eigen::Map<const Eigen::Matrix3d>{kg_m2->data()},
                 .sigma_fraction = std::sqrt(alignment.diagonal().segment<3>(InertiaError).mean())};
}

std::optional<NominalAttitude> nominal_attitude(const TomlValues& values) {
  using Frame = NominalAttitude::Frame;
  for (const auto& [key, frame] : {std::pair{"three_axis.nominal.q_orbit_body", Frame::Orbit},
                                   {"three_axis.nominal.q_icrf_body", Frame::Icrf}}) {
    if (const auto q_frame_body = quaternion_if(values, key)) {
      return NominalAttitude{.frame = frame, .q_frame_body = *q_frame_body};
    }
  }
  return std::nullopt;
}

}  // namespace

void check_fields_of_view(TomlDocument& document) {
  for (const std::string sensor : {"three_axis.sun_sensor", "three_axis.star_tracker"}) {
    const std::string boresight = sensor + ".boresight_body";
    const std::string half_angle = sensor + ".fov_deg";
    const auto vector = value_if<std::vector<double>>(document.values, boresight);
    if (vector.has_value() != document.values.contains(half_angle)) {
      const std::string& there = vector ? boresight : half_angle;
      add_problem(document, there,
                  fmt::format("{} without {}: a field of view has both", there,
                              vector ? half_angle : boresight));
    } else if (vector && Eigen::Vector3d{vector->data()}.norm() == 0.0) {
      add_problem(document, boresight,
                  fmt::format("{} = [0, 0, 0]: must have a direction", boresight));
    }
  }
}

ThreeAxisConfig three_axis_config(const TomlValues& values) {
  const AttitudeAlignment alignment = three_axis_alignment(values);
  return {.gyro = gyro(values),
          .sun_sensor = sun_sensor(values),
          .star_tracker = star_tracker(values),
          .magnetometer = magnetometer(values),
          .inertia = inertia(values, alignment),
          .nominal = nominal_attitude(values),
          .alignment = alignment};
}

}  // namespace spindrift
