/// @file
/// Simulated passes of a nutating body, and the errors of the nutation found in them.

#pragma once

#include <random>
#include <string>

#include "pipelines/ground_model/dynamics/spin_motion.h"
#include "pipelines/spin/nutation/nutation.h"
#include "tests/support/uniform_spin_residuals.h"

namespace spindrift::testing {

/// Simulates passes with timing noise of 0.1 ms (Sun) and 0.5 ms (infrared).
class NutationTrials {
 public:
  explicit NutationTrials(unsigned seed, double duration_s = 300.0)
      : duration_s_{duration_s}, rng_{seed} {}

  /// Returns a nutation with random phase of a prolate or oblate body whose nutation frequency
  /// differs by at least 0.03 from one that is unobservable.
  Nutation random_nutation(double half_angle_deg);

  /// Simulates the truth with this nutation and searches for it.
  NutationSearch searched(const Nutation& nutation);

  /// Returns the nutation that is found, as it has to be.
  FoundNutation found(const Nutation& nutation) { return searched(nutation).found.value(); }

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

/// @param nutation True nutation of a body that spins at the rate of `steady_truth`.
Deviations deviations(const FoundNutation& found, const Nutation& nutation);

std::string text_of(const Nutation& nutation);

}  // namespace spindrift::testing
