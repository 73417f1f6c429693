/// @file
/// Limits that tests of many stages share, and factors of the normal distribution. Where fewer
/// digits stand than are known, results are multiples of the number: more digits would change them.

#pragma once

namespace spindrift {

/// Beyond so many standard deviations things contradict each other: noise alone does it once in
/// 1.7 million, so that none of the thousands of measurements of a pass does.
inline constexpr double kContradictionSigmas = 5.0;
/// By that chance, for quantities of more than one dimension.
inline constexpr double kContradictionChance = 5.733e-7;
/// The same where the standard deviation is stated by people, as that of a prior is.
inline constexpr double kPriorSigmas = 3.0;
/// Measurements tell a bias where they leave at most so much of the sigma that its prior has.
inline constexpr double kObservableShare = 0.5;
/// A bias so many sigmas of its prior from zero is far off: more than what the prior allows for.
inline constexpr double kFarOffPriorSigmas = 4.0;

/// A larger share of outliers is no dirt, but another motion or noise. It is below a sixth: a wrong
/// axis may have all edges of five channels where they came, and none of the sixth.
inline constexpr double kManyOutliers = 0.15;

/// Chance that a search finds in noise alone what it looks for.
inline constexpr double kFalseAlarm = 1e-4;
/// Chi-square of two degrees of freedom that noise exceeds by that chance.
inline constexpr double kFalseAlarmSquares = 18.42;
/// So far above the limit of a search something is found in 95 of 100 cases, in sigmas.
inline constexpr double kDetectionSigmas = 1.645;

/// Half of all normal deviations are less than this many sigmas.
inline constexpr double kMedianDeviation = 0.6745;
/// Its inverse: standard deviation over median absolute deviation, or over half the distance of the
/// quartiles.
inline constexpr double kSigmaPerMad = 1.482602218505602;

}  // namespace spindrift
