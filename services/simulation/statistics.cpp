#include "services/simulation/statistics.h"

#include <cmath>
#include <numeric>

#include "pipelines/statistics/median.h"

namespace spindrift {
namespace {

Spread spread_of(std::vector<double> values) {
  const auto count = static_cast<double>(values.size());
  const double sum = std::accumulate(values.begin(), values.end(), 0.0);
  const double squares = std::inner_product(values.begin(), values.end(), values.begin(), 0.0);
  return {.mean = sum / count,
          .rms = std::sqrt(squares / count),
          .least = percentile(values, 0),
          .median = percentile(values, 50),
          .most_of_95 = percentile(values, 95),
          .most = percentile(values, 100)};
}

}  // namespace

std::vector<double> values_of(const MonteCarloResult& result, std::size_t measure) {
  std::vector<double> values;
  for (const RunResult& run : result.runs) {
    if (const auto& value = run.measures.at(measure).value) {
      values.push_back(*value);
    }
  }
  return values;
}

std::vector<MeasureStatistics> statistics_of(const MonteCarloResult& result) {
  std::vector<MeasureStatistics> all;
  for (std::size_t i = 0; i < result.runs.front().measures.size(); ++i) {
    std::vector<double> values = values_of(result, i);
    const auto count = static_cast<std::int64_t>(values.size());
    all.push_back(
        {.name = result.runs.front().measures[i].name,
         .count = count,
         .spread = values.empty() ? std::nullopt : std::optional{spread_of(std::move(values))}});
  }
  return all;
}

}  // namespace spindrift
