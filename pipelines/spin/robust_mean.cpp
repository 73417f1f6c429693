#include "pipelines/spin/robust_mean.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <vector>

namespace spindrift {
namespace {

constexpr std::size_t kFewValues = 10;
constexpr int kMostRounds = 20;
// Standard deviation of a Gaussian over its median absolute deviation.
constexpr double kSigmaPerMad = 1.482602218505602;

double median_of(std::vector<double>& scratch) {
  const auto middle = scratch.begin() + static_cast<std::ptrdiff_t>(scratch.size() / 2);
  std::nth_element(scratch.begin(), middle, scratch.end());
  if (scratch.size() % 2 == 1) {
    return *middle;
  }
  return 0.5 * (*middle + *std::max_element(scratch.begin(), middle));
}

}  // namespace

bool RobustMean::keeps(double value) const { return std::abs(value - mean) <= limit; }

RobustMean robust_mean(std::span<const double> values, const ClipRule& rule) {
  assert(!values.empty());
  const double floor = values.size() < kFewValues ? rule.sigma * rule.stated : rule.stated;

  std::vector<double> scratch(values.begin(), values.end());
  RobustMean result{};
  result.mean = median_of(scratch);
  std::transform(values.begin(), values.end(), scratch.begin(),
                 [&](double value) { return std::abs(value - result.mean); });
  result.limit = std::max(rule.sigma * kSigmaPerMad * median_of(scratch), floor);

  for (int round = 0; round < kMostRounds; ++round) {
    const RobustMean before = result;
    double sum = 0.0;
    result.kept = 0;
    for (const double value : values) {
      if (before.keeps(value)) {
        sum += value - before.mean;
        ++result.kept;
      }
    }
    if (result.kept == 0) {  // Only a limit below one standard deviation can come to this.
      return before;
    }
    result.mean = before.mean + sum / static_cast<double>(result.kept);
    double squares = 0.0;
    for (const double value : values) {
      if (before.keeps(value)) {
        squares += (value - result.mean) * (value - result.mean);
      }
    }
    result.sigma =
        result.kept > 1 ? std::sqrt(squares / static_cast<double>(result.kept - 1)) : rule.stated;
    result.limit = std::max(rule.sigma * result.sigma, floor);
    if (result.mean == before.mean && result.limit == before.limit) {
      break;
    }
  }
  return result;
}

}  // namespace spindrift
