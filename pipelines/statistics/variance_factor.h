/// @file
/// The global test of an adjustment: whether residuals over their stated sigmas say that the noise
/// is larger than stated. The sum of their squares is a chi-square with the mean `freedom` and the
/// variance 2 `freedom`. Its tail is longer than that of a normal variable: noise as stated exceeds
/// the limit by chances of 2e-4 at 15 degrees of freedom, 4e-6 at 300, 3e-7 in the end.

#pragma once

#include <cmath>

#include "pipelines/statistics/significance.h"

namespace spindrift {

/// Noise whose sigma is so many times what is stated is taken as the measurements show it.
inline constexpr double kLouder = 1.25;

/// By how much the variances exceed the stated ones; 1 unless significantly.
/// @param reduced_chi_square The mean square: the chi-square over its degrees of freedom.
/// @param freedom Above 0.
inline double variance_factor(double reduced_chi_square, double freedom) {
  return reduced_chi_square > 1.0 + kContradictionSigmas * std::sqrt(2.0 / freedom)
             ? reduced_chi_square
             : 1.0;
}

/// The same test of the sum of squares: whether noise as stated explains it.
inline bool noise_is_as_stated(double chi_square, double freedom) {
  return chi_square < freedom + kContradictionSigmas * std::sqrt(2.0 * freedom);
}

}  // namespace spindrift
