/// @file
/// Residuals that a steady spin leaves on the edges of a body that may nutate and cone.

#pragma once

#include <random>
#include <vector>

#include "pipelines/ground_model/sensors/spin_edges.h"
#include "pipelines/spin/nutation/tilt_signal.h"
#include "pipelines/spin/types/config.h"

namespace spindrift::testing {

/// Returns the usual sensors, mounted exactly as configured, at 60 rpm with axis and start of
/// `body_across_the_earth`.
SpinTruth steady_truth();

struct Turning {
  SpinTruth truth;
  std::vector<TrueEdge> edges;
};

/// Simulates the edges of `truth` on `orbit_across_the_earth`.
Turning turning(const SpinTruth& truth, double duration_s);

/// Returns the residuals of noisy edges against the steady spin (axis, phase, rate, drift) that
/// fits them best.
std::vector<UniformSpinResidual> uniform_spin_residuals(const Turning& turning,
                                                        const PulseNoise& noise,
                                                        std::mt19937_64& rng);

struct FittedConing {
  Eigen::Vector2d coning_rad;
  Eigen::Matrix2d covariance_rad2;
};

/// Returns the coning that fits the edges best together with a steady spin and the model errors.
/// @param alignment_sigma_rad Prior sigma of each model error about zero.
FittedConing fitted_coning(const Turning& turning, const PulseNoise& noise,
                           double alignment_sigma_rad, std::mt19937_64& rng);

}  // namespace spindrift::testing
