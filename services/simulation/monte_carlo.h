/// @file
/// Monte Carlo runs of a scenario, each simulated, written and processed like a single one.

#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "pipelines/core/expected.h"

namespace spindrift {

/// Result of a run in one number.
struct Measure {
  std::string name;             ///< Name with its unit, e.g. "batch_error_deg".
  std::optional<double> value;  ///< Value; empty where the run has no such result.
};

struct MonteCarloPlan {
  std::filesystem::path scenario;
  std::filesystem::path out;  ///< Output folder; run 12 is written to its folder 0012.
  std::int64_t runs;
  int jobs;  ///< Number of threads.
};

struct RunResult {
  std::int64_t run;  ///< Number of the run, from 0.
  std::int64_t seed;
  std::vector<Measure> measures;
};

struct MonteCarloResult {
  std::string spacecraft_id;
  std::vector<RunResult> runs;  ///< Results in order of the runs.
};

/// Simulates all runs, each depending on its seed alone. Shows progress on a terminal.
/// @return The error of the first run that fails, with its number; InvalidConfiguration for a
///         scenario with problems, and for an `out` that is not empty.
Expected<MonteCarloResult> monte_carlo(const MonteCarloPlan& plan);

}  // namespace spindrift
