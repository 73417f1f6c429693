/// Nutation is found where there is any, with honest errors, and not where there is none.

#include "pipelines/spin/nutation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "pipelines/frames/celestial.h"
#include "tests/support/steady_residuals.h"

namespace spindrift {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kDuration_s = 300.0;  // As many turns.
constexpr PulseNoise kNoise = {.sun_s = 1e-4, .infrared_s = 5e-4};

TEST(Probe, Probe) {
  std::mt19937_64 rng{1};
  SpinTruth truth = testing::steady_truth();
  const auto clean = testing::turning(truth, kDuration_s);
  for (int i = 0; i < 5; ++i) {
    const auto s = find_nutation(testing::steady_residuals(clean, kNoise, rng)).value();
    printf("clean far %g limit %g deg found %d\n", s.false_alarm, s.detectable_rad / kDegree, s.found.has_value());
  }
  for (double J : {0.08, 0.2, 0.37, 0.5, 0.63, 0.9, 1.2, 1.5, 1.8, 2.0}) {
    truth.motion.nutation = {.half_angle_rad = 0.2 * kDegree, .inertia_ratio = J, .first_azimuth_rad = 0.5};
    const auto t = testing::turning(truth, kDuration_s);
    const auto s = find_nutation(testing::steady_residuals(t, kNoise, rng)).value();
    printf("J %g far %g limit %g deg found %d\n", J, s.false_alarm, s.detectable_rad / kDegree, s.found.has_value());
    if (s.found) {
      const auto& f = *s.found;
      const double lean = wrapped_rad(0.5 + truth.motion.nutation.per_turn() * truth.motion.rate_rad_s * f.t_s);
      printf("   t %g half %g +- %g; growth %g +- %g; period %g (%g) +- %g; lean %g +- %g off; others %zu\n", f.t_s,
             f.half_angle_rad.value / kDegree, f.half_angle_rad.sigma / kDegree, f.growth_per_s.value, f.growth_per_s.sigma,
             f.period_s.value, 1/truth.motion.nutation.per_turn(), f.period_s.sigma, wrapped_rad(f.lean_azimuth_rad.value - lean),
             f.lean_azimuth_rad.sigma, f.other_periods_s.size());
    }
  }
}

}  // namespace
}  // namespace spindrift
