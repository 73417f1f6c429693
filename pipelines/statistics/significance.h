/// @file
/// Shared test limits and factors of the normal distribution. A factor given to few digits must
/// stay as it is: results are multiples of it, and more digits would change them.

#pragma once

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

}  // namespace spindrift
