/// @file
/// Multi-start fit: the likeliest of the axes that the starts converge to.

#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "pipelines/spin/batch/evaluated_fit.h"

namespace spindrift {

/// Twice the log likelihood ratio that settles an axis: it is exp(10) times as likely. `sequential`
/// asks for exp(20), since it decides again after every revolution.
inline constexpr double kSettled = 20.0;

/// Holds another axis and the misfit of its best state.
struct OtherAxis {
  Eigen::Vector3d axis_icrf;
  double more_misfit;  ///< Misfit beyond that of the best axis.
};

/// Holds the likeliest fit and its competitors.
struct Best {
  EvaluatedFit best;
  std::optional<Eigen::Vector3d> alternate_axis_icrf;
  std::optional<OtherAxis> other;  ///< Likeliest of all other axes, including those ruled out.
  bool by_prior = false;           ///< True when only the mission's prior decides against `other`.
};

/// @param starts Starting axes, unit vectors in ICRF, at least one.
/// @return The error of the first start when every start fails.
Expected<Best> best_of_starts(const PassModel& model, std::span<const PassEdge> edges,
                              std::span<const Eigen::Vector3d> starts, BiasSet estimated);

/// Compares the best fit with another axis, refined by at most some thousands of edges, which is
/// enough for an axis that is no start. If it converges to the best axis, `axis_icrf` itself is
/// compared, with phase and rate fitted. An edge that the axis would not give counts as an outlier.
OtherAxis compared_with(const EvaluatedFit& best, const PassModel& model,
                        std::span<const PassEdge> edges, const Eigen::Vector3d& axis_icrf);

}  // namespace spindrift
