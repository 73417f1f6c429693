/// @file
/// What an even spin leaves of the edges of a body that may nutate and cone.

#pragma once

#include <random>
#include <vector>

#include "pipelines/ground_model/sensors/spin_edges.h"
#include "pipelines/spin/nutation/uniform_spin_residual.h"
#include "pipelines/spin/types/config.h"

namespace spindrift::testing {

/// The usual sensors, exactly where they are said to be, at 60 rpm; axis and
/// start of `body_across_the_earth`.
SpinTruth steady_truth();

struct Turning {
  SpinTruth truth;
  std::vector<TrueEdge> edges;
};

/// On `orbit_across_the_earth`.
Turning turning(const SpinTruth& truth, double duration_s);

/// Residuals of the edges, with noise on each time, against the spin about the axis, phase, rate
/// and drift that fit them best.
std::vector<UniformSpinResidual> uniform_spin_residuals(const Turning& turning,
                                                        const PulseNoise& noise,
                                                        std::mt19937_64& rng);

struct FittedConing {
  Eigen::Vector2d coning_rad;
  Eigen::Matrix2d covariance_rad2;
};

/// Coning that fits the edges best, with all that a steady spin has and the errors of the model.
/// @param alignment_sigma_rad To which each error is known to be zero.
FittedConing fitted_coning(const Turning& turning, const PulseNoise& noise,
                           double alignment_sigma_rad, std::mt19937_64& rng);

}  // namespace spindrift::testing
