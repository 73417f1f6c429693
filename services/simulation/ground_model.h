/// @file
/// The ground model that a scenario describes.

#pragma once

#include <filesystem>
#include <memory>
#include <span>

#include "pipelines/core/expected.h"
#include "pipelines/ground_model/comparison/model_comparison.h"
#include "services/mission/mission.h"
#include "services/simulation/scenario.h"

namespace spindrift {

/// @return InvalidConfiguration where the scenario cannot be played, or has no noise to judge by.
Expected<GroundModel> ground_model_of(const Scenario& scenario);

/// That of a scenario file. @param mission Of the spacecraft that it must be of.
/// @return as load_scenario and ground_model_of; InvalidConfiguration for another spacecraft, or
///         one of another kind.
Expected<std::shared_ptr<const GroundModel>> load_ground_model(const std::filesystem::path& path,
                                                               const Mission& mission);

/// Of the missions that name one. @return with every problem, one a line.
Expected<GroundModels> load_ground_models(std::span<const Mission> missions);

}  // namespace spindrift
