/// @file
/// The scenario of a pass to simulate: what there really is, what the mission file says of it, and
/// what goes wrong.

#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <variant>

#include "pipelines/core/expected.h"
#include "pipelines/ephemeris/orbit.h"
#include "pipelines/time/tai_time.h"
#include "services/mission/document.h"
#include "services/simulation/orientation_scenario.h"
#include "services/simulation/separation_scenario.h"
#include "services/simulation/spin_scenario.h"
#include "services/simulation/tumbling_scenario.h"

namespace spindrift {

struct Scenario {
  std::string spacecraft_id;
  Orbit orbit;
  std::optional<std::filesystem::path> oem;  ///< The orbit's file, where it is as in one.
  TaiTime start;
  double duration_s;
  /// In the order of ScenarioKind.
  std::variant<SpinScenario, SeparationScenario, TumblingScenario, OrientationScenario> flight;
  /// The mission file that goes with it, but for what a separation tells; its orbit is orbit.oem.
  std::string mission_toml;
};

/// The file by the rules of its kind (scenario_schema.h); what breaks them stands in `problems`.
/// @return InvalidConfiguration for what cannot be read or is not TOML.
Expected<TomlDocument> read_scenario(const std::filesystem::path& path);

/// Likewise of a table that is not as it stands in the file. @param path Named in problems.
Expected<TomlDocument> checked_scenario(const std::filesystem::path& path, toml::table table);

/// With the orbit file that it names. @return As load_scenario.
Expected<Scenario> scenario_of(TomlDocument document, std::optional<TaiTime> other_start = {});

/// Reads a scenario, and the orbit file that it names, by the rules of its kind
/// (scenario_schema.h).
/// @param other_start In the place of the scenario's. The orbit moves with it: the spacecraft is
///        where it would have been as long after the scenario's start, in ICRF; the Sun is where it
///        is then.
/// @return InvalidConfiguration with every problem, one a line:
///         "FILE:LINE: KEY = VALUE: what is allowed"; the line where one is to blame.
Expected<Scenario> load_scenario(const std::filesystem::path& path,
                                 std::optional<TaiTime> other_start = {});

}  // namespace spindrift
