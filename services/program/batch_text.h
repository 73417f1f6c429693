/// @file
/// Formats a solution of the estimator `batch` as text and as JSON.

#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "pipelines/spin/batch/batch_solution.h"

namespace spindrift {

/// Returns several lines on bound, biases and undetermined directions, each with a line end.
std::string to_text(const BatchSolution& solution);

/// Returns only the members to be merged into the JSON object of the estimate.
nlohmann::json to_json(const BatchSolution& solution);

}  // namespace spindrift
