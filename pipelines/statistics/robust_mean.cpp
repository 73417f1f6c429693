#include "pipelines/statistics/robust_mean.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>
#include <numeric>
#include <span>

#include "pipelines/statistics/significance.h"

namespace spindrift {
namespace {

double median_of_sorted(std::span<const double> sorted) {
  const std::size_t middle = sorted.size() / 2;
  return sorted.size() % 2 == 1 ? sorted[middle] : 0.5 * (sorted[middle - 1] + sorted[middle]);
}

/// Returns the median of |value - centre|; deviations grow outwards on both sides of the centre.
double median_deviation(std::span<const double> sorted, double centre) {
  auto above = std::lower_bound(sorted.begin(), sorted.end(), centre);
  auto below = std::make_reverse_iterator(above);
  double before = 0.0;
  double last = 0.0;
  for (std::size_t taken = 0; taken <= sorted.size() / 2; ++taken) {
    before = last;
    const bool upwards =
        below == sorted.rend() || (above != sorted.end() && *above - centre <= centre - *below);
    last = upwards ? *above++ - centre : centre - *below++;
  }
  return sorted.size() % 2 == 1 ? last : 0.5 * (before + last);
}

/// Returns the values within the limit, which are contiguous.
std::span<const double> kept_by(const RobustMean& mean, std::span<const double> sorted) {
  const auto first = std::partition_point(sorted.begin(), sorted.end(), [&](double value) {
    return value < mean.mean && !mean.keeps(value);
  });
  const auto end = std::partition_point(
      first, sorted.end(), [&](double value) { return value < mean.mean || mean.keeps(value); });
  return {first, end};
}

RobustMean robust_mean(std::span<const double> sorted, const ClipRule& rule) {
  const double floor = sorted.size() < 10 ? rule.sigma * rule.stated : rule.stated;
  RobustMean result{};
  result.mean = median_of_sorted(sorted);
  result.limit = std::max(rule.sigma * kSigmaPerMad * median_deviation(sorted, result.mean), floor);

  std::span<const double> kept_before;
  for (int round = 0; round < 20; ++round) {
    const RobustMean before = result;
    const std::span<const double> kept = kept_by(before, sorted);
    const bool same_set = kept.data() == kept_before.data() && kept.size() == kept_before.size();
    if (same_set || kept.empty()) {  // A limit below one standard deviation can keep none.
      return before;
    }
    kept_before = kept;
    result.kept = kept.size();
    const double sum =
        std::accumulate(kept.begin(), kept.end(), 0.0,
                        [&](double so_far, double value) { return so_far + value - before.mean; });
    result.mean = before.mean + sum / static_cast<double>(kept.size());
    const double squares =
        std::accumulate(kept.begin(), kept.end(), 0.0, [&](double so_far, double value) {
          return so_far + (value - result.mean) * (value - result.mean);
        });
    result.sigma =
        result.kept > 1 ? std::sqrt(squares / static_cast<double>(result.kept - 1)) : rule.stated;
    result.limit = std::max(rule.sigma * result.sigma, floor);
  }
  return result;
}

}  // namespace

bool RobustMean::keeps(double value) const { return std::abs(value - mean) <= limit; }

SlidingRobustMean::SlidingRobustMean(std::size_t length) : length_{length} {
  assert(length > 0);
  ring_.reserve(length);
  sorted_.reserve(length);
}

void SlidingRobustMean::add(double value) {
  if (ring_.size() < length_) {
    ring_.push_back(value);
  } else {
    sorted_.erase(std::lower_bound(sorted_.begin(), sorted_.end(), ring_[next_]));
    ring_[next_] = value;
    next_ = (next_ + 1) % length_;
  }
  sorted_.insert(std::upper_bound(sorted_.begin(), sorted_.end(), value), value);
}

RobustMean SlidingRobustMean::mean(const ClipRule& rule) const {
  assert(!sorted_.empty());
  return robust_mean(sorted_, rule);
}

}  // namespace spindrift
