/// @file
/// Output of Monte Carlo runs as text, JSON and SVG.

#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "services/simulation/monte_carlo.h"

namespace spindrift {

/// Returns a CSV row per run: run, seed and its measures; empty where there is none.
std::string runs_csv(const MonteCarloResult& result);

/// Returns a table with a row per measure.
std::string statistics_text(const MonteCarloResult& result);

/// Returns `runs`, an object of numbers each (null: none), and `statistics` by measure.
nlohmann::ordered_json statistics_json(const MonteCarloResult& result);

/// Returns an SVG with a histogram of each measure.
std::string histograms(const MonteCarloResult& result);

}  // namespace spindrift
