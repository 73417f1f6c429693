/// @file
/// What the scenarios of all flights of a three-axis spacecraft have in common.

#pragma once

#include <Eigen/Core>
#include <optional>
#include <string_view>

#include "pipelines/ground_model/flights/three_axis_flights.h"
#include "pipelines/three_axis/config.h"
#include "pipelines/time/tai_time.h"
#include "services/mission/document.h"
#include "services/mission/scalar.h"

namespace spindrift {

/// Empty where the key is absent.
std::optional<Eigen::Vector3d> vector_if(const TomlValues& values, std::string_view key);
/// Zero where it is absent.
Eigen::Vector3d vector_or_zero(const TomlValues& values, std::string_view key);
/// Of a key in degrees; empty where it is absent.
std::optional<Eigen::Vector3d> radians_vector_if(const TomlValues& values, std::string_view key);

/// When each sensor gives its first sample, behind the start.
struct FirstSamples {
  double gyro_s = 0.0;
  double sun_s = 0.0;
  double star_s = 0.0;
  double magnetometer_s = 0.0;
};

/// @param values In which no problem was found.
ThreeAxisView three_axis_view(const TomlValues& values, const ThreeAxisConfig& said,
                              const FirstSamples& first);
BodyTruth body_truth(const TomlValues& values, const ThreeAxisConfig& said, TaiTime start);

/// Adds a problem for the instant of `key` where it is beyond the pass.
void check_within_pass(TomlDocument& document, std::string_view key);

/// Adds one where there is no sensor to send anything, and for the truth of a sensor that is not
/// there.
void check_sensors_on_board(TomlDocument& document);

/// Adds one where the body at the start turns too fast for steps of the period of `key`.
void check_body_step(TomlDocument& document, std::string_view key);

}  // namespace spindrift
