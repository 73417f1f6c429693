/// @file
/// Order statistics of values in any order.

#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

namespace spindrift {

/// Returns the value at place `n` from 0 of the values in rising order. Reorders them.
inline double in_order_at(std::span<double> values, std::size_t n) {
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(n);
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

/// Returns the median, the upper of two; 0 for no values. Reorders them.
inline double upper_median(std::span<double> values) {
  return values.empty() ? 0.0 : in_order_at(values, values.size() / 2);
}

/// Returns the nearest-rank percentile, the least value that `percent` % of the values do not
/// exceed. @param values Not empty; reordered.
inline double percentile(std::span<double> values, std::size_t percent) {
  const std::size_t rank = (values.size() * percent + 99) / 100;
  return in_order_at(values, std::max(rank, std::size_t{1}) - 1);
}

}  // namespace spindrift
