/// @file
/// Simulation of a scenario: the received telemetry, and the truth about it.

#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pipelines/core/expected.h"
#include "pipelines/ground_model/dynamics/body_motion.h"
#include "pipelines/ground_model/flights/orientation_motion.h"
#include "services/simulation/on_board_pass.h"
#include "services/simulation/scenario.h"
#include "services/telemetry/by_kind.h"

namespace spindrift {

struct Counted {
  std::string_view plural;  ///< Plural of what is counted, e.g. "edges".
  std::int64_t count;
};

/// Whether progress is shown on a terminal.
enum class Progress { Shown, Hidden };

struct SimulatedPass {
  std::vector<TelemetryKind> kinds;  ///< Kinds of telemetry that the scenario requests.
  PlacedValues telemetry;            ///< Telemetry of these kinds; it arrives in order of time.
  std::string mission_toml;
  nlohmann::ordered_json truth;
  std::vector<Counted> made;
  std::vector<Counted> faults;
  std::optional<BodyMotion> motion = {};     ///< Motion of a three-axis spacecraft.
  std::vector<ControlRecord> control = {};   ///< Records of its wheels, where they turn it.
  std::optional<OnBoardPass> on_board = {};  ///< Present if the satellite carries a table.
};

/// @return InvalidConfiguration where the scenario's orbit does not allow it.
Expected<SimulatedPass> simulated_pass(const Scenario& scenario,
                                       Progress progress = Progress::Shown);

}  // namespace spindrift
