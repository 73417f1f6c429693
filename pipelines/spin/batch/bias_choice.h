/// @file
/// Significance of biases, where the mission file does not say which to estimate.

#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "pipelines/spin/batch/pass_information.h"

namespace spindrift {

struct BiasGain {
  SensorBias bias;  ///< Of coning, both unknowns, ConingX.
  double gain;      ///< Of log likelihood, times two: of noise alone, a chi-square of one degree,
                    ///< of coning two.
};

/// The gain from which on a bias explains what noise does not; for coning, which has two unknowns,
/// it is higher.
double significance_gain(SensorBias bias);

/// Those that would explain the residuals, beside those that are estimated already, best first.
/// @param information At the best state with these.
/// @return Empty where noise explains them as well: at a chance of 1e-4 a pass there is one.
std::vector<BiasGain> significant_biases(const PassInformation& information, BiasSet estimated);

/// The first of them.
std::optional<BiasGain> most_significant_bias(const PassInformation& information,
                                              BiasSet estimated);

/// Mean square of what the axis would move by, were not `chosen` but another bias the true one,
/// each weighted with how likely the residuals make it; tilts of the frame `spin`, rad^2.
/// @param information At the best state without it.
Eigen::Matrix2d other_biases_rad2(const PassInformation& information, BiasSet estimated,
                                  SensorBias chosen);

}  // namespace spindrift
