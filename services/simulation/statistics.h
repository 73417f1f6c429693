/// @file
/// Statistics of many runs.

#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "services/simulation/monte_carlo.h"

namespace spindrift {

struct Spread {
  double mean;
  double rms;
  double least;
  double median;
  double most_of_95;  ///< 95th percentile.
  double most;
};

/// Statistics of one measure over all runs.
struct MeasureStatistics {
  std::string name;
  std::int64_t count;  ///< Number of runs that have the measure.
  std::optional<Spread> spread;
};

/// Returns the statistics in the order of the measures.
std::vector<MeasureStatistics> statistics_of(const MonteCarloResult& result);

/// Returns the values of the measure with that index, of the runs that have it, in their order.
std::vector<double> values_of(const MonteCarloResult& result, std::size_t measure);

}  // namespace spindrift
