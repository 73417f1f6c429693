/// @file
/// The spin period, and one measured interval as a candidate for it.

#pragma once

#include <optional>

#include "pipelines/core/rational.h"
#include "pipelines/observation/rejection.h"

namespace spindrift {

/// One interval between edges `turns` revolutions apart, divided by them.
struct PeriodCandidate {
  double period_s;
  double sigma_s;  ///< From the stated pulse noise.
  /// By its test, or with the edge that it ends at; empty: accepted.
  std::optional<Rejection> rejected_by;
  /// What the test expected, and how far from that it may be; empty: it was rejected with its edge.
  std::optional<Rational> test = {};
};

/// At an instant.
struct SpinPeriod {
  double period_s;
  double sigma_s;
  double drift_per_s2 = 0.0;  ///< Of the spin rate in turns a second.
};

}  // namespace spindrift
