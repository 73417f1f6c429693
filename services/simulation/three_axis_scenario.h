/// @file
/// The scenarios of all flights of a three-axis spacecraft, and what they share.

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

/// Returns the vector of `key`; empty where the key is absent.
std::optional<Eigen::Vector3d> vector_if(const TomlValues& values, std::string_view key);
/// Returns the vector of `key`; zero where the key is absent.
Eigen::Vector3d vector_or_zero(const TomlValues& values, std::string_view key);
/// Returns the vector of a key in degrees, in rad; empty where the key is absent.
std::optional<Eigen::Vector3d> radians_vector_if(const TomlValues& values, std::string_view key);

/// Times of the first sample of each sensor, since the start.
struct FirstSamples {
  double gyro_s = 0.0;
  double sun_s = 0.0;
  double star_s = 0.0;
  double magnetometer_s = 0.0;
};

/// @param values Values of a scenario without problems.
ThreeAxisView three_axis_view(const TomlValues& values, const ThreeAxisConfig& said,
                              const FirstSamples& first);
BodyTruth body_truth(const TomlValues& values, const ThreeAxisConfig& said, TaiTime start);

/// Adds a problem where the instant of `key` is after the end of the pass.
void check_within_pass(TomlDocument& document, std::string_view key);

/// Adds a problem where no sensor sends anything, and for the truth of an absent sensor.
void check_sensors_on_board(TomlDocument& document);

/// Adds a problem where the body turns too fast at the start for steps of the period of `key`.
void check_body_step(TomlDocument& document, std::string_view key);

/// @name Scenarios by flight
/// The checks add the problems that the schema cannot detect; values are of a scenario without any.
/// @{
void check_separation_scenario(TomlDocument& document);
/// @param start Time of separation.
SeparationScenario separation_scenario(const TomlValues& values, TaiTime start);

/// A lost satellite that tumbles.
void check_tumbling_scenario(TomlDocument& document);
TumblingScenario tumbling_scenario(const TomlValues& values, TaiTime start);

/// A satellite that turns to an attitude by its wheels.
void check_orientation_scenario(TomlDocument& document);
OrientationScenario orientation_scenario(const TomlValues& values, TaiTime start);

/// A satellite that is lost, and returns to its commanded attitude by its magnetometer alone.
void check_rescue_scenario(TomlDocument& document);
RescueScenario rescue_scenario(const TomlValues& values, TaiTime start);
/// @}

}  // namespace spindrift
