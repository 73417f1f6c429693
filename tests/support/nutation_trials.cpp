#include "tests/support/nutation_trials.h"

#include <fmt/format.h>

#include <cmath>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"

namespace spindrift::testing {

Nutation NutationTrials::random_nutation(double half_angle_deg) {
  std::uniform_real_distribution<double> uniform;
  while (true) {
    const double inertia_ratio = 0.03 + 1.94 * uniform(rng_);
    if (std::abs(inertia_ratio - 1.0) > 0.03) {
      return {.half_angle_rad = half_angle_deg * kRadPerDeg,
              .inertia_ratio = inertia_ratio,
              .first_azimuth_rad = 2.0 * std::numbers::pi * uniform(rng_)};
    }
  }
}

NutationSearch NutationTrials::searched(const Nutation& nutation) {
  truth.motion.nutation = nutation;
  constexpr PulseNoise kNoise = {.sun_s = 1e-4, .infrared_s = 5e-4};
  return find_nutation(uniform_spin_residuals(turning(truth, duration_s_), kNoise, rng_)).value();
}

Deviations deviations(const FoundNutation& found, const Nutation& nutation) {
  const double rate_rad_s = steady_truth().motion.rate_rad_s;
  const double period_s = 2.0 * std::numbers::pi / (rate_rad_s * nutation.per_turn());
  const double period_off_s = std::abs(found.period_s.value - period_s);
  const double lean_rad = nutation.first_azimuth_rad + nutation.per_turn() * rate_rad_s * found.t_s;
  return {.period_share = period_off_s / period_s,
          .period_sigmas = period_off_s / found.period_s.sigma,
          .half_angle_sigmas = std::abs(found.half_angle_rad.value - nutation.half_angle_rad) /
                               found.half_angle_rad.sigma,
          .lean_sigmas = std::abs(wrapped_rad(found.lean_azimuth_rad.value - lean_rad)) /
                         found.lean_azimuth_rad.sigma};
}

std::string text_of(const Nutation& nutation) {
  return fmt::format("inertia ratio {}, phase {} rad", nutation.inertia_ratio,
                     nutation.first_azimuth_rad);
}

}  // namespace spindrift::testing
