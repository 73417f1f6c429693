/// @file
/// An operator's action on the telemetry of one spacecraft, an input like a sample.

#pragma once

#include <optional>
#include <string>
#include <variant>

#include "pipelines/spin/types/spin_action.h"
#include "pipelines/supervision/limits.h"
#include "pipelines/three_axis/attitude_action.h"
#include "pipelines/time/tai_time.h"
#include "services/telemetry/places.h"

namespace spindrift {

struct OperatorAction {
  std::string action_id;
  std::string spacecraft;
  /// Start of the telemetry it applies to; empty: what comes after the run takes it.
  std::optional<TaiTime> t;
  std::string made_utc;
  std::string by;
  std::string action;     ///< Name as in `schemas/tables.sql`.
  std::string arguments;  ///< A JSON object.
  std::string note;
  std::variant<SpinAction, AttitudeAction, SetLimit> does;  ///< `action` and `arguments`, parsed.
  RunPlace arrival = {};  ///< Its place among the samples of the run that took it.
};

}  // namespace spindrift
