/// @file
/// A solution of the estimator `batch` for people and for programs.

#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "pipelines/spin/batch/batch_solution.h"

namespace spindrift {

/// Bound, biases and what the edges leave open; several lines, each ending in a line end.
std::string to_text(const BatchSolution& solution);

/// What an estimate of another kind does not have: to be added to its own object.
nlohmann::json to_json(const BatchSolution& solution);

}  // namespace spindrift
