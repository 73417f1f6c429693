/// @file
/// Computes what the samples of a chain say of its nodes and of the shared errors, in linear time
/// and memory, by an information filter augmented with the shared errors, followed by a smoother;
/// and what that leaves open, with the prior covariance of the shared errors.
///
/// The fit estimates the gyro bias and the misalignment of the sun sensor. All other shared errors
/// are considered: it takes them as zero, and its errors follow them.

#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "pipelines/observation/normal_equations.h"
#include "pipelines/reconstruction/chain.h"
#include "pipelines/reconstruction/shared_errors.h"
#include "pipelines/three_axis/alignment_evidence.h"

namespace spindrift {

/// Holds the linear problem at a solution. The error of a node is own + per_shared * (shared
/// errors), with independent own errors and shared errors.
struct ChainInformation {
  std::vector<Eigen::Matrix3d> own_rad2;  ///< Covariance if the shared errors were zero.
  std::vector<PerShared> per_shared;
  SharedCovariance shared;  ///< Information of the samples on the shared errors, without priors.
  SharedVector score;       ///< Gradient that belongs to `shared`, at the solution.
};

ChainInformation information_of(const Chain& chain, const ChainState& state);

/// Returns what the samples say of the errors of the mission file, in the order of kOfAlignment,
/// with the gyro bias eliminated.
/// @param t Time of the last sample.
NormalEquations normal_equations(const ChainInformation& known, const ChainNoise& noise,
                                 const ChainState& state, TaiTime t);

/// Returns the errors that the fit leaves.
SharedErrors errors_of(const ChainInformation& known, const ChainNoise& noise);

/// Returns the least covariance that any estimate of all shared errors leaves.
SharedCovariance least_errors_of(const ChainInformation& known, const ChainNoise& noise);

/// Holds the shared errors that explain the samples best, within their priors.
struct FittedFile {
  /// How far the shared errors lie from those of the fit, which takes most of them as zero. What is
  /// left of the residuals is free of the errors of the mission file.
  SharedVector change = SharedVector::Zero();
  std::optional<ErrorBeyond> beyond = std::nullopt;
};

FittedFile fitted_file(const ChainInformation& known, const ChainNoise& noise,
                       const ChainState& state);

/// Returns the covariance that errors of the mission file give to a residual at `node`.
Eigen::Matrix3d allowed_by_file(const ChainResidual& residual, const PerShared& node_per_shared,
                                const SharedErrors& errors);

/// Returns what is left of a residual at `node` after a change of the shared errors.
Eigen::Vector3d left_of(const ChainResidual& residual, const PerShared& node_per_shared,
                        const SharedVector& change);

}  // namespace spindrift
