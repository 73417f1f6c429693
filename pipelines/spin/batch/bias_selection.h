/// @file
/// Forward selection of biases where the mission file does not say which to estimate: significant
/// ones are added to the fit one after the other.

#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "pipelines/spin/batch/evaluated_fit.h"
#include "pipelines/spin/batch/pass_information.h"

namespace spindrift {

struct BiasGain {
  SensorBias bias;  ///< Bias; ConingX stands for both unknowns of coning.
  double gain;      ///< Twice the gain of log likelihood, a chi-square under pure noise.
};

/// Returns the gain above which noise does not explain a bias; it is higher for coning, which has
/// two unknowns.
double significance_gain(SensorBias bias);

/// Returns the gain above which noise does not explain a parameter of one degree of freedom.
double significance_gain();

/// Returns the biases, beyond those already estimated, that would explain the residuals, best
/// first.
/// @param information Equations at the best state with `estimated`.
/// @return Empty when noise explains the residuals; a false alarm has a chance of 1e-4 per pass.
std::vector<BiasGain> significant_biases(const PassInformation& information, BiasSet estimated);

std::optional<BiasGain> most_significant_bias(const PassInformation& information,
                                              BiasSet estimated);

/// Returns the mean square motion of the axis if another bias than `chosen` were the true one, each
/// weighted with its likelihood; as tilts of the frame `spin`, rad^2.
/// @param information Equations at the best state without `chosen`.
Eigen::Matrix2d other_biases_rad2(const PassInformation& information, BiasSet estimated,
                                  SensorBias chosen);

struct BiasSelection {
  EvaluatedFit best;          ///< Fit with all significant biases estimated.
  Eigen::Matrix2d open_rad2;  ///< Axis uncertainty from the choice among biases, tilts.
};

/// @return The errors of fit().
Expected<BiasSelection> select_biases(const PassModel& model, std::span<const PassEdge> edges,
                                      EvaluatedFit without);

}  // namespace spindrift
