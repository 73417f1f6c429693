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

/// The likeliest, and another that is nearly so.
struct Best {
  EvaluatedFit best;
  std::optional<Eigen::Vector3d> alternate_axis_icrf;
};

/// @param starts Unit, ICRF, at least one.
/// @return Why the first start leads nowhere, where none does.
Expected<Best> best_of_starts(const PassModel& model, std::span<const PassEdge> edges,
                              std::span<const Eigen::Vector3d> starts, BiasSet estimated);

}  // namespace spindrift
