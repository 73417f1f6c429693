/// @file
/// An angle, or a function of angles, with its derivatives by the error sources.

#pragma once

#include <Eigen/Core>
#include <unsupported/Eigen/AutoDiff>

#include "pipelines/spin/measurement/measurement.h"
#include "pipelines/spin/types/model_allowance.h"
#include "pipelines/spin/types/pulse.h"

namespace spindrift {

inline constexpr int kEdges = static_cast<int>(kPulseChannels);

/// Number with derivatives, first per standard deviation of each edge's time, then per radian of
/// each model error.
using Uncertain = Eigen::AutoDiffScalar<Eigen::Matrix<double, kEdges + kModelErrors, 1>>;

/// Returns the standard deviation from the noise of the edges.
inline double noise_of(const Uncertain& value) { return value.derivatives().head<kEdges>().norm(); }

/// Returns the standard deviation from the model errors.
inline double model_uncertainty_of(const Uncertain& value) {
  return value.derivatives().tail<kModelErrors>().norm() * kModelError_rad;
}

inline Uncertain certain(double value) { return {value, Uncertain::DerType::Zero()}; }

inline Uncertain uncertain(const Measured& measured) {
  Uncertain value = certain(measured.value_rad);
  value.derivatives().head<kEdges>() = measured.noise_rad;
  return value;
}

inline Uncertain with_model_error(Uncertain value, ModelError error) {
  value.derivatives()(kEdges + error) += 1.0;
  return value;
}

}  // namespace spindrift
