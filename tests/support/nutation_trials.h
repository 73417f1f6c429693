/// @file
/// Passes of a nutating body, and how far off what is found of it is.

#pragma once

#include <random>
#include <string>

#include "pipelines/ground_model/dynamics/spin_motion.h"
#include "pipelines/spin/nutation/nutation.h"
#include "tests/support/uniform_spin_residuals.h"

namespace spindrift::testing {

/// Each of 300 turns, with 0.1 ms (Sun) and 0.5 ms (infrared) of noise.
class NutationTrials {
 public:
  explicit NutationTrials(unsigned seed, double duration_s = 300.0)
      : duration_s_{duration_s}, rng_{seed} {}

  /// Of any phase, slender or flat, its frequency not within 0.03 of one that cannot be seen.
  Nutation random_nutation(double half_angle_deg);

  /// The truth, nutating so.
  NutationSearch searched(const Nutation& nutation);

  SpinTruth truth = steady_truth();

 private:
  double duration_s_;
  std::mt19937_64 rng_;
};

struct Deviations {
  double period_share;
  double period_sigmas;
  double half_angle_sigmas;
  double lean_sigmas;
};

/// @param nutation Of a body with the rate of `steady_truth`.
Deviations deviations(const FoundNutation& found, const Nutation& nutation);

std::string text_of(const Nutation& nutation);

}  // namespace spindrift::testing
