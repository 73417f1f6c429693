/// @file
/// Quantiles and tail probabilities, computed by Boost.Math.

#pragma once

namespace spindrift {

/// Returns the value that a standard normal variable exceeds with probability `chance`, (0, 1).
double normal_beyond(double chance);

/// Returns the value that a chi-square variable exceeds with probability `chance`, (0, 1).
double chi_square_beyond(double chance, double freedom);

/// Returns P(chi-square > squares), squares >= 0.
double chi_square_tail(double squares, double freedom);

/// Returns P(F > ratio), ratio >= 0, for a ratio of two variances; degrees of freedom above 0.
double variance_ratio_tail(double freedom_above, double freedom_below, double ratio);

}  // namespace spindrift
