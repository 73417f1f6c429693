/// @file
/// The spin period, and one measured interval as a candidate for it.

#pragma once

#include <optional>

#include "pipelines/core/rational.h"

namespace spindrift {

/// One interval between edges `turns` revolutions apart, divided by them.
struct PeriodCandidate {
  double period_s;
  double sigma_s;  ///< From the stated pulse noise.
  bool accepted;
  /// What the test expected, and how far from that it may be; empty: it ends at an edge that is
  /// known to be wrong.
  std::optional<Rational> test = {};
};

/// At an instant.
struct SpinPeriod {
  double period_s;
  double sigma_s;
  double drift_per_s2 = 0.0;  ///< Of the spin rate in turns a second.
};

}  // namespace spindrift
