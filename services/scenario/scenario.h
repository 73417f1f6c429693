/// @file
/// The scenario of a pass to simulate: what there really is, what the mission file says of it, and
/// what goes wrong.

#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "pipelines/core/expected.h"
#include "pipelines/ephemeris/orbit.h"
#include "pipelines/ground_model/pulse_link.h"
#include "pipelines/ground_model/spin_edges.h"

namespace spindrift {

struct SimulatedTelemetry {
  bool pulses;
  bool coded;
  double coded_resolution_s;
};

struct Scenario {
  std::string spacecraft_id;
  Orbit orbit;
  std::optional<std::string> oem_text;  ///< Of the orbit's file, where it is from one.
  double duration_s;
  SpinTruth truth;
  PulseLink link;
  SimulatedTelemetry telemetry;
  std::string mission_toml;  ///< The mission file that goes with it; its orbit is orbit.oem.
};

/// Reads a scenario, and the orbit file that it names, by the rules of schemas/scenario.schema.toml
/// and schemas/mission.schema.toml.
/// @return InvalidConfiguration with every problem, one a line:
///         "FILE:LINE: KEY = VALUE: what is allowed"; the line where one is to blame.
Expected<Scenario> load_scenario(const std::filesystem::path& path);

}  // namespace spindrift
