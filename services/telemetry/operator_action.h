/// @file
/// An operator's word on the telemetry of one spacecraft: input, like a sample.

#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>

#include "pipelines/spin/types/spin_action.h"
#include "pipelines/three_axis/attitude_action.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

struct OperatorAction {
  std::string action_id;
  std::string spacecraft;
  /// Telemetry from then on is meant. Empty: from as far as it has come, until a run takes it.
  std::optional<TaiTime> t;
  std::string made_utc;
  std::string by;
  std::string action;     ///< As in `schemas/tables.sql`.
  std::string arguments;  ///< A JSON object.
  std::string note;
  std::variant<SpinAction, AttitudeAction> does;  ///< What the two say, by kind of spacecraft.
  std::int64_t arrival = 0;                       ///< Among the samples of the run that took it.
};

}  // namespace spindrift
