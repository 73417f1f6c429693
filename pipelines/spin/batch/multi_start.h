/// @file
/// Multi-start fit: the likeliest of the axes that the starts converge to.

#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "pipelines/spin/batch/evaluated_fit.h"

namespace spindrift {

/// Twice a difference of log likelihoods: exp(10) times as likely settles it. The filters of
/// `sequential` ask for exp(20), since they decide again after every revolution.
inline constexpr double kSettled = 20.0;

/// Another axis, with the state that explains the edges best about it.
struct OtherAxis {
  Eigen::Vector3d axis_icrf;
  double more_misfit;  ///< Than about the best.
};

/// The likeliest, and another that is nearly so.
struct Best {
  EvaluatedFit best;
  std::optional<Eigen::Vector3d> alternate_axis_icrf;
  std::optional<OtherAxis> other;  ///< The likeliest of all others, those ruled out included.
  bool by_prior = false;           ///< That is nearly so likely, but not what the mission expects.
};

/// @param starts Unit, ICRF, at least one.
/// @return Why the first start leads nowhere, where none does.
Expected<Best> best_of_starts(const PassModel& model, std::span<const PassEdge> edges,
                              std::span<const Eigen::Vector3d> starts, BiasSet estimated);

/// The axis that `axis_icrf` leads to by some thousands of edges, which is enough for one that is
/// no start; where that is the best one, itself, with phase and rate fitted. An edge that it would
/// not give counts as an outlier.
OtherAxis compared_with(const EvaluatedFit& best, const PassModel& model,
                        std::span<const PassEdge> edges, const Eigen::Vector3d& axis_icrf);

}  // namespace spindrift
