/// @file
/// Scenario of a pass to simulate: the truth, what the mission file says of it, and the faults.

#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <variant>

#include "pipelines/core/expected.h"
#include "pipelines/ephemeris/orbit.h"
#include "pipelines/geomagnetism/tables/field_table.h"
#include "pipelines/ground_model/flights/three_axis_flights.h"
#include "pipelines/time/tai_time.h"
#include "services/mission/document.h"
#include "services/simulation/spin_scenario.h"

namespace spindrift {

/// Table of the field on board (field_table.h), of the first revolution of the orbit's elements.
struct CarriedTable {
  TableKind kind;
  int points;
};

struct Scenario {
  std::string spacecraft_id;
  Orbit orbit;
  std::optional<std::filesystem::path> oem;  ///< Orbit file; empty for an orbit of elements.
  TaiTime start;
  double duration_s;
  /// Flight of the scenario; the alternatives are in the order of ScenarioKind.
  std::variant<SpinScenario, SeparationScenario, TumblingScenario, OrientationScenario,
               RescueScenario>
      flight;
  /// Text of its mission file, without the reports of a separation; its orbit is orbit.oem.
  std::string mission_toml;
  std::optional<CarriedTable> carried_table;  ///< The table that a three-axis spacecraft carries.
};

/// Reads a scenario file and lists violations of its schema (scenario_schema.h) in `problems`.
/// @return InvalidConfiguration for what cannot be read or is not TOML.
Expected<TomlDocument> read_scenario(const std::filesystem::path& path);

/// Checks a table that differs from the file's. @param path File named in problems.
Expected<TomlDocument> checked_scenario(const std::filesystem::path& path, toml::table table);

/// Makes the scenario, with the orbit file that it names. @return Errors of load_scenario.
Expected<Scenario> scenario_of(TomlDocument document, std::optional<TaiTime> other_start = {});

/// Reads a scenario, checked by its schema (scenario_schema.h), and the orbit file it names.
/// @param other_start Start in place of the scenario's. The orbit is shifted in time with it, with
///        the same states in ICRF; the Sun is where it is at the new time.
/// @return InvalidConfiguration with one problem per line: "FILE:LINE: KEY = VALUE: what is
///         allowed"; the line number only where one line is to blame.
Expected<Scenario> load_scenario(const std::filesystem::path& path,
                                 std::optional<TaiTime> other_start = {});

}  // namespace spindrift
