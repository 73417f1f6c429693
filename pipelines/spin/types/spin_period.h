/// @file
/// The spin period, and one measured interval as a candidate for it.

#pragma once

#include <optional>

#include "pipelines/core/rational.h"
#include "pipelines/observation/rejection.h"

namespace spindrift {

/// One interval between two edges, divided by the number of revolutions between them.
struct PeriodCandidate {
  double period_s;
  double sigma_s;  ///< One sigma from the stated pulse noise.
  /// Rejection by its test, or with the edge that it ends at; empty: accepted.
  std::optional<Rejection> rejected_by;
  /// Expectation and limit of the test; empty: it was rejected with its edge.
  std::optional<Rational> test = {};
};

struct SpinPeriod {
  double period_s;
  double sigma_s;
  double drift_per_s2 = 0.0;  ///< Drift of the spin rate in turns a second.
};

}  // namespace spindrift
