/// @file
/// Many runs for people and for programs.

#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "services/simulation/monte_carlo.h"

namespace spindrift {

/// A row a run: run, seed and its measures; empty where there is none.
std::string runs_csv(const MonteCarloResult& result);

/// A row a measure.
std::string statistics_text(const MonteCarloResult& result);

/// `runs`, each an object of its numbers, null where there is none, and `statistics`, by measure.
nlohmann::ordered_json statistics_json(const MonteCarloResult& result);

/// SVG: a histogram of each measure.
std::string histograms(const MonteCarloResult& result);

}  // namespace spindrift
