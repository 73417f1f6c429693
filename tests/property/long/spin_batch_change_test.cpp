#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/spin/batch/batch_estimator.h"
#include "pipelines/spin/pass/spin_pass.h"
#include "services/base/assessment_words.h"
#include "tests/support/batch_pass.h"
#include "tests/support/dirt.h"
#include "tests/support/product_text.h"
#include "tests/support/solved_pass.h"

namespace spindrift::testing::spin_batch_change_test {

constexpr double kPi = std::numbers::pi;
constexpr double kRpm_rad_s = kPi / 30.0;

/// Solves the pass as `process` does at its end.
Expected<BatchSolution> solved(const SpinConfig& config, const Orbit& orbit,
                               const std::vector<Pulse>& pulses) {
  return testing::solved(config, orbit, run(SpinPass{config, orbit}, pulses));
}

std::vector<Pulse> dirty_pulses(const SpinningBody& body, const SunEarthEphemeris& around,
                                double from_s, double to_s, const Dirt& dirt,
                                std::mt19937_64& rng) {
  const auto clean = noisy_pulses(body, edges_between(body, around, from_s, to_s), rng);
  return dirty(clean, body.seconds_of(1.0), dirt, rng).pulses;
}

constexpr Dirt kDirt{.lost = 0.05, .spoilt = 0.05};

TEST(SpinBatchChange, IsNotMadeOfTheDirtOfASteadyPass) {
  BatchScene scene{3101};
  std::uniform_real_distribution<double> uniform;
  int solutions = 0;
  for (int pass = 0; pass < 200; ++pass) {
    SpinningBody body = random_body(scene.around, 3.0 * kRadPerDeg, scene.rng);
    body.rate_rad_s = 5.0 * std::pow(40.0, uniform(scene.rng)) * kRpm_rad_s;
    const double turns = 10.0 + 20.0 * uniform(scene.rng);
    SCOPED_TRACE(fmt::format("pass {}: {:.1f} turns at {:.1f} rpm", pass, turns,
                             body.rate_rad_s / kRpm_rad_s));
    const auto solution =
        solved(body.config, scene.orbit,
               dirty_pulses(body, scene.around, 0.0, body.seconds_of(turns), kDirt, scene.rng));
    if (solution) {
      ++solutions;
      EXPECT_FALSE(solution->changed) << sentence_of(solution->estimate.assessment);
    }
  }
  EXPECT_GT(solutions, 150);
}

/// Holds a pass with the Sun 6 deg from the axis, so that sun2 and the north beam see nothing: four
/// axes are possible, and the fixes chose a false one.
struct HardPass {
  Orbit orbit = transfer_with_node(91.06809);
  SunEarthEphemeris around = seen_from(orbit, ellipsoidal_horizon_km(40.0));
  SpinningBody body{.axis_icrf = direction_icrf(
                        {.ra_rad = 61.455876 * kRadPerDeg, .dec_rad = 19.945283 * kRadPerDeg}),
                    .rate_rad_s = 150.0 * kRpm_rad_s,
                    .first_turn_rad = 0.0,
                    .config = usual_config()};

  HardPass() {
    body.config.south->mount_angle_rad = 120.0 * kRadPerDeg;
    body.config.south->azimuth_rad = 120.0 * kRadPerDeg;
    body.config.horizon.model = HorizonModel::Ellipsoid;
  }
};

TEST(SpinBatchChange, DoesNotExplainAFalseAxis) {
  HardPass hard;
  std::mt19937_64 rng{3102};
  for (int pass = 0; pass < 10; ++pass) {
    SCOPED_TRACE(pass);
    hard.body.first_turn_rad = 0.3 * pass;
    const auto solution = solved(
        hard.body.config, hard.orbit,
        dirty_pulses(hard.body, hard.around, 0.0, 120.0, {.lost = 0.03, .spoilt = 0.02}, rng));
    if (!solution || !is_unopposed(solution->estimate.assessment.quality)) {
      continue;
    }
    const SpinEstimate& estimate = solution->estimate;
    EXPECT_LT(error_sigmas(estimate, hard.body.axis_icrf), 5.0) << sentence_of(estimate.assessment);
    EXPECT_FALSE(solution->changed) << sentence_of(estimate.assessment);
  }
}

/// Solves ten minutes of disturbed edges of a body whose axis moves by `by_rad` at `at_s`.
Expected<BatchSolution> solved_moved(BatchScene& scene, double at_s, double by_rad) {
  SpinningBody after = scene.body;
  after.axis_icrf =
      Eigen::AngleAxisd{by_rad, after.axis_icrf.unitOrthogonal()} * scene.body.axis_icrf;
  auto pulses = dirty_pulses(scene.body, scene.around, 0.0, at_s, kDirt, scene.rng);
  const auto later = dirty_pulses(after, scene.around, at_s, 600.0, kDirt, scene.rng);
  pulses.insert(pulses.end(), later.begin(), later.end());
  std::sort(pulses.begin(), pulses.end());
  auto solution = solved(scene.body.config, scene.orbit, pulses);
  scene.body = after;
  return solution;
}

TEST(SpinBatchChange, IsFoundInDirtAndDated) {
  BatchScene scene{3103};
  for (const double by_deg : {0.57, 2.0, 10.0}) {
    SCOPED_TRACE(by_deg);
    scene.body = random_body(scene.around, 3.0 * kRadPerDeg, scene.rng);
    const auto solution = solved_moved(scene, 240.0, by_deg * kRadPerDeg);
    ASSERT_TRUE(solution) << solution.error().message;
    SCOPED_TRACE(sentence_of(solution->estimate.assessment));
    ASSERT_TRUE(solution->changed);
    // The change is located to a 64th of the pass or the neighbouring one.
    EXPECT_NEAR(seconds_between(kTransferStart, *solution->changed), 240.0, 20.0);
    EXPECT_TRUE(is_unopposed(solution->estimate.assessment.quality));
    EXPECT_LT(error_sigmas(solution->estimate, scene.body.axis_icrf), 4.0);
  }
}

TEST(SpinBatchChange, IsDoubtedWhereItLeavesOutMostOfThePass) {
  BatchScene scene{3104};
  const auto solution = solved_moved(scene, 450.0, 2.0 * kRadPerDeg);
  ASSERT_TRUE(solution) << solution.error().message;
  EXPECT_EQ(solution->estimate.assessment.quality, Quality::Doubtful);
  EXPECT_TRUE(has(solution->estimate.assessment, ReasonCode::MostBeforeChange));
  EXPECT_FALSE(has(solution->estimate.assessment, ReasonCode::NoAxisBeforeChange));
}

}  // namespace spindrift::testing::spin_batch_change_test
