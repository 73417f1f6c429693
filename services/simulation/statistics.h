/// @file
/// What many runs say together.

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
  double most_of_95;  ///< 95 of 100 are not larger.
  double most;
};

/// Of one measure over all runs.
struct MeasureStatistics {
  std::string name;
  std::int64_t count;  ///< Of runs that have it.
  std::optional<Spread> spread;
};

/// In the order of the measures.
std::vector<MeasureStatistics> statistics_of(const MonteCarloResult& result);

/// That of one measure in the runs that have it, in their order. @param measure By its place.
std::vector<double> values_of(const MonteCarloResult& result, std::size_t measure);

}  // namespace spindrift
