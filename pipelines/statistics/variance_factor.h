/// @file
/// The global test of an adjustment: whether the whitened residuals show more noise than stated.
/// Their sum of squares is chi-square distributed with mean `freedom` and variance 2 `freedom`. As
/// its tail is longer than normal, noise as stated exceeds the limit with probability 2e-4 at 15
/// degrees of freedom, 4e-6 at 300, and 3e-7 in the limit.

#pragma once

#include <cmath>

#include "pipelines/statistics/significance.h"

namespace spindrift {

/// Ratio of actual to stated sigma above which the actual noise is used.
inline constexpr double kLouder = 1.25;

/// Returns the ratio of actual to stated variance if significantly above 1; else 1.
/// @param reduced_chi_square Chi-square over its degrees of freedom.
/// @param freedom Above 0.
inline double variance_factor(double reduced_chi_square, double freedom) {
  return reduced_chi_square > 1.0 + kContradictionSigmas * std::sqrt(2.0 / freedom)
             ? reduced_chi_square
             : 1.0;
}

/// Returns whether noise as stated explains a sum of squares, by the same test.
inline bool noise_is_as_stated(double chi_square, double freedom) {
  return chi_square < freedom + kContradictionSigmas * std::sqrt(2.0 * freedom);
}

}  // namespace spindrift
