/// @file
/// Many runs of a scenario, each simulated, written and processed as one alone would be.

#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "pipelines/core/expected.h"
#include "services/simulation/run_outcome.h"

namespace spindrift {

struct MonteCarloPlan {
  std::filesystem::path scenario;
  std::filesystem::path out;  ///< Run 12 goes to the folder 0012 in it.
  std::int64_t runs;
  int jobs;  ///< Threads.
};

struct RunResult {
  std::int64_t run;  ///< From 0.
  std::int64_t seed;
  std::vector<Measure> measures;
};

struct MonteCarloResult {
  std::string spacecraft_id;
  std::vector<RunResult> runs;  ///< In order, whatever came first.
};

/// Each run depends on its seed alone. Shows its progress on a terminal.
/// @return the first run's error that has one, named; InvalidConfiguration for a scenario that is
///         not sound, and an `out` that is not empty.
Expected<MonteCarloResult> monte_carlo(const MonteCarloPlan& plan);

}  // namespace spindrift
