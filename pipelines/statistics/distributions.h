/// @file
/// Quantiles and tails of distributions, by Boost.Math.

#pragma once

namespace spindrift {

/// What a standard normal variable exceeds by such a chance, (0, 1).
double normal_beyond(double chance);

/// What a chi-square of so many degrees of freedom, above 0, exceeds by such a chance, (0, 1).
double chi_square_beyond(double chance, double freedom);

/// The other way: P(chi-square > squares), squares >= 0.
double chi_square_tail(double squares, double freedom);

/// P(F > ratio), ratio >= 0, of the ratio of two variances with so many degrees of freedom, above
/// 0.
double variance_ratio_tail(double freedom_above, double freedom_below, double ratio);

}  // namespace spindrift
