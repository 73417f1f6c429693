/// @file
/// Passes whose times are truncated to a grid, and the errors of the estimators on them.

#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/spin/batch/batch_estimator.h"
#include "pipelines/spin/batch/pass_edges.h"
#include "pipelines/spin/pass/spin_pass.h"
#include "tests/support/observed_spin.h"
#include "tests/support/spinning_body.h"

namespace spindrift::testing {

/// Returns pulses with times truncated, not rounded, to multiples of `grid_ns`.
inline std::vector<Pulse> cut(std::vector<Pulse> pulses, std::int64_t grid_ns) {
  for (Pulse& pulse : pulses) {
    const std::int64_t t_ns = tai_ns(pulse.t);
    pulse.t = tai_from_ns(t_ns - t_ns % grid_ns);
  }
  std::sort(pulses.begin(), pulses.end());
  return pulses;
}

/// Holds the error statistics of one estimator.
struct OnGrid {
  int rows = 0;
  int ok = 0;                ///< Number of OK rows.
  double most_sigmas = 0.0;  ///< Largest axis error of an OK row, sigma; below, that of the rate.
  double most_rate_sigmas = 0.0;

  void note(const SpinEstimate& estimate, const SpinningBody& body) {
    ++rows;
    if (estimate.assessment.quality != Quality::Ok) {
      return;
    }
    ++ok;
    most_sigmas = std::max(most_sigmas, angle_between_rad(estimate.axis_icrf, body.axis_icrf) /
                                            std::sqrt(estimate.covariance_rad2.trace()));
    most_rate_sigmas =
        std::max(most_rate_sigmas, std::abs(estimate.spin_rate_rad_s - body.rate_rad_s) /
                                       estimate.spin_rate_sigma_rad_s);
  }
  OnGrid& operator+=(const OnGrid& other) {
    rows += other.rows;
    ok += other.ok;
    most_sigmas = std::max(most_sigmas, other.most_sigmas);
    most_rate_sigmas = std::max(most_rate_sigmas, other.most_rate_sigmas);
    return *this;
  }
};

struct PassOnGrid {
  OnGrid mean;
  OnGrid sequential;
  OnGrid batch;
  double sigma_deg = 0.0;  ///< Axis sigma of the last `batch` solution.
};

/// Runs a body of random geometry at this rate and checks every row of `mean` and `sequential`, and
/// `batch` on a half, three quarters and all of the pass.
/// @param grid_ns Grid width; 1 for none.
inline PassOnGrid pass_on_grid(double rpm, std::int64_t grid_ns, std::uint64_t seed,
                               double revolutions) {
  const Surroundings from;
  std::mt19937_64 rng{seed};
  SpinningBody body = random_body(from.around, 8.0 * kRadPerDeg, rng);
  body.rate_rad_s = rpm * kTurn_rad / 60.0;
  const auto edges = edges_between(body, from.around, 0.0, revolutions * 60.0 / rpm);
  const std::vector<Pulse> pulses = cut(noisy_pulses(body, edges, rng), grid_ns);
  PassOnGrid found;
  SpinPass pass{body.config, from.orbit};
  PassEdges so_far;
  const auto take = [&](const SpinOutput& output) {
    for (const SpinProduct& product : output.products) {
      so_far.collect(product);
      if (const auto* const estimate = std::get_if<SpinEstimate>(&product)) {
        (estimate->estimator == SpinEstimator::Mean ? found.mean : found.sequential)
            .note(*estimate, body);
      }
    }
  };
  const auto solve = [&] {
    PassEdges these = so_far;
    const StartingAxes starts = these.starts(std::nullopt);
    if (const auto solution =
            solve_batch(body.config, from.orbit, std::move(these).edges(), starts)) {
      found.batch.note(solution->estimate, body);
      found.sigma_deg = degrees(std::sqrt(solution->estimate.covariance_rad2.trace()));
    }
  };
  for (std::size_t i = 0; i < pulses.size(); ++i) {
    take(pass.push(pulses[i]));
    if (i == pulses.size() / 2 || i == 3 * pulses.size() / 4) {
      solve();
    }
  }
  take(pass.finish());
  solve();
  return found;
}

/// Rates whose periods are multiples of a millisecond, of smaller units, nearly so, or not at all.
inline constexpr double kRatesOnGrid_rpm[] = {60.0, 30.0,    100.0,   50.0, 75.0,    40.0,  99.2177,
                                              61.3, 47.91,   33.3333, 90.0, 66.6667, 120.0, 45.0,
                                              80.0, 59.9999, 60.0003, 55.5, 85.7143, 71.7};

}  // namespace spindrift::testing
