/// @file
/// Shared test limits and factors of the normal distribution. A factor given to few digits must
/// stay as it is: results are multiples of it, and more digits would change them.

#pragma once

#include <cmath>

namespace spindrift {

/// Standard deviations beyond which values contradict each other. Noise exceeds this once in 1.7
/// million, so that it does not occur among the thousands of measurements of a pass.
inline constexpr double kContradictionSigmas = 5.0;
/// The same probability, for quantities of more than one dimension.
inline constexpr double kContradictionChance = 5.733e-7;
/// Contradiction limit if the standard deviation was stated by a person, as for a prior.
inline constexpr double kPriorSigmas = 3.0;
/// A bias is observable if measurements reduce its prior sigma to this share or less.
inline constexpr double kObservableShare = 0.5;
/// A bias this many prior sigmas from zero is implausible.
inline constexpr double kFarOffPriorSigmas = 4.0;

/// A larger share of outliers indicates another motion or noise. It is below one sixth because a
/// wrong axis may fit the edges of five channels and none of the sixth.
inline constexpr double kManyOutliers = 0.15;

/// Probability that a search finds a signal in noise alone.
inline constexpr double kFalseAlarm = 1e-4;
/// Chi-square of two degrees of freedom that noise exceeds with probability kFalseAlarm.
inline constexpr double kFalseAlarmSquares = 18.42;
/// Sigmas above the limit of a search at which a signal is found with 95 % probability.
inline constexpr double kDetectionSigmas = 1.645;

/// Median absolute deviation of a normal variable, in sigmas.
inline constexpr double kMedianDeviation = 0.6745;
/// Ratio of standard deviation to median absolute deviation, or to half the quartile distance.
inline constexpr double kSigmaPerMad = 1.482602218505602;

/// Ratio of actual to stated sigma above which the actual noise is used.
inline constexpr double kLouder = 1.25;

/// @name Global test of an adjustment
/// Whether the whitened residuals show more noise than stated. Their sum of squares is chi-square
/// distributed with mean `freedom` and variance 2 `freedom`. As its tail is longer than normal,
/// noise as stated exceeds the limit with probability 2e-4 at 15 degrees of freedom, 4e-6 at 300,
/// and 3e-7 in the limit.
/// @{
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
/// @}

}  // namespace spindrift
