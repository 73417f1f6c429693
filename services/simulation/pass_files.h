/// @file
/// A simulated pass as files: telemetry, orbit, mission file and truth.

#pragma once

#include <filesystem>
#include <vector>

#include "pipelines/core/expected.h"
#include "services/simulation/scenario.h"
#include "services/simulation/simulated_pass.h"

namespace spindrift {

/// Writes a file of each kind of telemetry (pulses.csv, gyro.csv, ...), orbit.oem, mission.toml and
/// truth.json into `folder`, which is made if absent. Files of these names are replaced.
/// @return Paths of the written files. InvalidConfiguration, before anything is written, for a
///         folder that holds another *.csv, since a folder given as telemetry means all of them;
///         Unavailable when writing fails, which leaves no partial file.
Expected<std::vector<std::filesystem::path>> write_pass(const std::filesystem::path& folder,
                                                        const Scenario& scenario,
                                                        const SimulatedPass& pass);

}  // namespace spindrift
