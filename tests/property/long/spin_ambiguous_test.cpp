/// Passes whose ambiguity cannot be resolved are reported as AMBIGUOUS, and the true axis is among
/// the named ones.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/spin/pass/spin_pass.h"
#include "pipelines/spin/types/model_allowance.h"
#include "services/base/assessment_words.h"
#include "tests/support/assessed.h"
#include "tests/support/observed_spin.h"
#include "tests/support/product_text.h"
#include "tests/support/random_pass.h"

namespace spindrift::testing::spin_ambiguous_test {

constexpr double kSigmas = 5.0;

/// Returns whether two axes agree within noise and the allowance for model errors.
bool is_near(const Eigen::Vector3d& axis_icrf, double sigma_rad, const Eigen::Vector3d& true_icrf) {
  return angle_between_rad(axis_icrf, true_icrf) < kSigmas * sigma_rad + kModelLimit_rad;
}

/// Returns whether the true axis is the fix's axis or one of its alternates.
bool lists(const SpinFix& fix, const Eigen::Vector3d& true_icrf) {
  bool found = is_near(fix.axis_icrf, std::sqrt(fix.covariance_rad2.trace()), true_icrf);
  for (const SpinAlternate& alternate : fix.alternates) {
    found = found ||
            is_near(alternate.axis_icrf, std::sqrt(alternate.covariance_rad2.trace()), true_icrf);
  }
  return found;
}

/// Returns whether the true axis is the estimate's axis or the one that its assessment names.
bool names(const SpinEstimate& estimate, const Eigen::Vector3d& true_icrf) {
  const double sigma_rad = testing::sigma_rad(estimate);
  if (is_near(estimate.axis_icrf, sigma_rad, true_icrf)) {
    return true;
  }
  const auto& reasons = estimate.assessment.reasons;
  const double ra_deg = number_of(reasons, ReasonCode::OtherAxis, "ra_deg");
  const double dec_deg = number_of(reasons, ReasonCode::OtherAxis, "dec_deg");
  return has(estimate.assessment, ReasonCode::OtherAxis) &&
         is_near(direction_icrf({.ra_rad = ra_deg * kRadPerDeg, .dec_rad = dec_deg * kRadPerDeg}),
                 sigma_rad, true_icrf);
}

/// Returns whether the estimate claims that only the two axes it names are possible.
bool claims_to_name_all(const SpinEstimate& estimate) {
  return estimate.assessment.quality == Quality::Ambiguous &&
         has(estimate.assessment, ReasonCode::OtherAxis) &&
         has(estimate.assessment, ReasonCode::Revolutions);
}

TEST(SpinAmbiguous, CandidatesThatNothingSettlesAreSaidToBeAmbiguousToTheEnd) {
  // Without sun slit 1, two axes fit all edges of this pass alike.
  const Orbit orbit = orbit_across_the_earth();
  const SpinningBody body = body_across_the_earth();
  auto edges = edges_between(body, seen_from(orbit), 0.0, 300.0);
  std::erase_if(edges, [](const auto& edge) { return edge.channel == PulseChannel::Sun1; });
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 rng{seed};
    const SpinOutput output = run(SpinPass{body.config, orbit}, noisy_pulses(body, edges, rng));
    const auto fixes = all_of<SpinFix>(output);
    EXPECT_GT(fixes.size(), 250U);
    for (const SpinFix& fix : fixes) {
      EXPECT_EQ(fix.resolution, Resolution::Ambiguous) << fix.revolution;
      EXPECT_FALSE(fix.accepted) << fix.revolution;
      EXPECT_TRUE(lists(fix, body.axis_icrf)) << fix.revolution;
    }
    const auto estimates = estimates_of(output, SpinEstimator::Sequential);
    EXPECT_GT(estimates.size(), 200U);
    for (const SpinEstimate& estimate : estimates) {
      EXPECT_TRUE(estimate.assessment.quality == Quality::Ambiguous)
          << sentence_of(estimate.assessment);
      EXPECT_TRUE(names(estimate, body.axis_icrf)) << sentence_of(estimate.assessment);
    }
    EXPECT_TRUE(std::any_of(output.notices.begin(), output.notices.end(), [](const Notice& notice) {
      return notice.values == std::vector{NamedValue{"geometry_case", std::int64_t{7}}};
    }));
  }
}

TEST(SpinAmbiguous, WhatClaimsToNameAllCandidatesNamesTheTrueOne) {
  constexpr int kPasses = 400;
  constexpr double kRevolutions = 250.0;
  int claiming = 0;
  int without_truth = 0;
  for (int pass = 0; pass < kPasses; ++pass) {
    std::mt19937_64 rng{static_cast<std::uint64_t>(pass)};
    const RandomPass drawn = random_pass(rng);
    if (drawn.dead.empty()) {
      continue;
    }
    SCOPED_TRACE(std::to_string(pass) + ": " + drawn.name);
    int missed = 0;
    std::string last;
    const SpinOutput output =
        run(SpinPass{drawn.body.config, drawn.orbit}, drawn.pulses(kRevolutions, rng));
    for (const SpinEstimate& estimate : estimates_of(output, SpinEstimator::Sequential)) {
      if (claims_to_name_all(estimate)) {
        ++claiming;
        missed += names(estimate, drawn.body.axis_icrf) ? 0 : 1;
        last = names(estimate, drawn.body.axis_icrf) ? last : sentence_of(estimate.assessment);
      }
    }
    EXPECT_EQ(missed, 0) << last;
    without_truth += missed;
  }
  RecordProperty("claiming", claiming);
  RecordProperty("without_truth", without_truth);
  EXPECT_GT(claiming, 1000);
}

}  // namespace spindrift::testing::spin_ambiguous_test
