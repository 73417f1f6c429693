/// @file
/// A contradiction between sensors, and the one of them that is wrong.

#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pipelines/core/assessment.h"
#include "pipelines/observation/observation.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

struct SensorContradiction {
  /// The sensor that, left out, makes the others agree; empty if nothing tells which of two it is.
  std::optional<SampleSource> culprit;
  /// The sensors that contradict the culprit; without a culprit the two that contradict each other.
  std::vector<SampleSource> with;
  NamedValue off;  ///< Difference of the sensors: `angle_deg` or `offset_s`.
  double sigmas;   ///< The difference over its total standard deviation.
  TaiTime since;
};

/// Says whether the sensors contradict each other, judged by the samples up to `t`.
struct SensorsCompared {
  TaiTime t;
  std::optional<SensorContradiction> contradiction;  ///< Empty: they do not.
};

/// Returns the name of a sensor in the key of an alert; an orbit state stands for the orbit.
std::string sensor_name_of(SampleSource source);
/// Stands for the culprit where nothing tells which of the sensors it is.
inline constexpr std::string_view kUnknownCulprit = "unknown";
/// Returns the name of the culprit, or `unknown`.
std::string culprit_name_of(const SensorContradiction& contradiction);
/// Returns the names of the sensors in `with`.
std::vector<std::string> opponents_of(const SensorContradiction& contradiction);
/// Returns these names as one text, separated by commas.
std::string opponents_text(const SensorContradiction& contradiction);

Reason reason_of(const SensorContradiction& contradiction);

}  // namespace spindrift
