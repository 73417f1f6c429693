/// @file
/// Ground model of a scenario.

#pragma once

#include <filesystem>
#include <memory>
#include <span>

#include "pipelines/core/expected.h"
#include "pipelines/ground_model/comparison/model_comparison.h"
#include "services/mission/mission.h"
#include "services/simulation/scenario.h"

namespace spindrift {

/// @return InvalidConfiguration where the scenario cannot be simulated, or has no noise.
Expected<GroundModel> ground_model_of(const Scenario& scenario);

/// Loads the ground model of a scenario file. @param mission Mission of the same spacecraft.
/// @return Errors of load_scenario and ground_model_of; InvalidConfiguration for another
///         spacecraft, or one of another kind.
Expected<std::shared_ptr<const GroundModel>> load_ground_model(const std::filesystem::path& path,
                                                               const Mission& mission);

/// Loads the ground models of the missions that name one. @return Errors with one problem per line.
Expected<GroundModels> load_ground_models(std::span<const Mission> missions);

}  // namespace spindrift
