/// @file
/// Passes of bodies that differ from their mission file by errors drawn from what the file states.

#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "pipelines/frames/angle.h"
#include "pipelines/spin/pass/spin_pass.h"
#include "tests/support/misaligned.h"
#include "tests/support/observed_spin.h"
#include "tests/support/solved_pass.h"
#include "tests/support/spinning_body.h"

namespace spindrift::testing {

struct MisalignedSpinPass {
  SpinConfig said;  ///< What the mission file says.
  Eigen::Vector3d axis_icrf;
  std::vector<Pulse> pulses;
};

/// Draws bodies, and the errors of their mission files.
class MisalignedPasses {
 public:
  MisalignedPasses(std::uint64_t seed, double duration_s) : duration_s_{duration_s}, rng_{seed} {}

  /// @param states Covariance that the mission file states. @param errors Covariance of its errors.
  MisalignedSpinPass drawn(const SpinAlignment& states, const SpinAlignment& errors) {
    std::normal_distribution<double> normal;
    SpinningBody body = random_body(from_.around, 6.0 * kRadPerDeg, rng_);
    body.config.alignment = states;
    SpinAlignmentVector unit;
    std::generate(unit.begin(), unit.end(), [&] { return normal(rng_); });
    return of(body, root_of(errors) * unit);
  }

  /// Returns the pass of this body with errors that the mission file does not have.
  MisalignedSpinPass of(const SpinningBody& body, const SpinAlignmentVector& errors) {
    SpinningBody flown = body;
    flown.config = true_config(body.config, errors);
    const SunEarthEphemeris around =
        seen_from(from_.orbit, spherical_horizon_km(flown.config.horizon.co2_altitude_km));
    return {.said = body.config,
            .axis_icrf = body.axis_icrf,
            .pulses = noisy_pulses(flown, edges_between(flown, around, 0.0, duration_s_), rng_)};
  }
  SpinningBody body() { return random_body(from_.around, 6.0 * kRadPerDeg, rng_); }
  const Orbit& orbit() const { return from_.orbit; }

 private:
  double duration_s_;
  std::mt19937_64 rng_;
  Surroundings from_;
};

/// Sums how far estimators are off in many passes.
struct AlignmentSums {
  int passes = 0;
  std::array<int, 3> answers{};  ///< Last rows that are OK, by SpinEstimator.
  std::array<double, 3>
      squares{};        ///< Their normalised squared errors: two degrees of freedom each.
  int rows = 0;         ///< All rows that have seen enough to be OK.
  int ok = 0;           ///< All OK rows.
  int beyond_four = 0;  ///< Of these, how many are off by more than four sigmas.
  double worst = 0.0;   ///< Sigmas of the worst OK row.

  void add(const SpinEstimate& estimate, const Eigen::Vector3d& axis_icrf) {
    rows += estimate.assessment.quality == Quality::Converging ? 0 : 1;
    if (estimate.assessment.quality == Quality::Ok) {
      const double sigmas = error_sigmas(estimate, axis_icrf);
      ++ok;
      beyond_four += sigmas > 4.0 ? 1 : 0;
      worst = std::max(worst, sigmas);
    }
  }
  void add_answer(const SpinEstimate& estimate, const Eigen::Vector3d& axis_icrf) {
    if (estimate.assessment.quality == Quality::Ok) {
      const auto i = static_cast<std::size_t>(estimate.estimator);
      ++answers.at(i);
      squares.at(i) += squared_error(estimate, axis_icrf);
    }
  }
  void add(const MisalignedSpinPass& pass, const Orbit& orbit) {
    const SpinOutput output = run(SpinPass{pass.said, orbit}, pass.pulses);
    for (const SpinEstimate& estimate : all_of<SpinEstimate>(output)) {
      add(estimate, pass.axis_icrf);
    }
    for (const SpinEstimator estimator : {SpinEstimator::Mean, SpinEstimator::Sequential}) {
      add_answer(last_estimate(output, estimator), pass.axis_icrf);
    }
    const auto solution = solved(pass.said, orbit, output);
    ASSERT_TRUE(solution) << solution.error().message;
    add(solution->estimate, pass.axis_icrf);
    add_answer(solution->estimate, pass.axis_icrf);
    ++passes;
  }

  void record(const std::string& name) const {
    const auto property = [&](const std::string& what, double value) {
      ::testing::Test::RecordProperty(name + " " + what, std::to_string(value));
    };
    for (const SpinEstimator estimator :
         {SpinEstimator::Mean, SpinEstimator::Sequential, SpinEstimator::Batch}) {
      const auto i = static_cast<std::size_t>(estimator);
      property(std::string{name_of(estimator)} + " OK", answers.at(i));
      property(std::string{name_of(estimator)} + " squares", squares.at(i) / answers.at(i));
    }
    property("rows", rows);
    property("OK", ok);
    property("beyond four", beyond_four);
    property("worst", worst);
  }
};

}  // namespace spindrift::testing
