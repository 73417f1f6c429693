/// @file
/// Checks every row of the estimator `mean`, not only the last, in passes of random geometry.

#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <variant>
#include <vector>

#include "pipelines/frames/celestial.h"
#include "pipelines/spin/pass/spin_pass.h"
#include "services/base/assessment_words.h"
#include "tests/support/dirt.h"
#include "tests/support/product_text.h"
#include "tests/support/random_pass.h"

namespace spindrift::testing {

inline constexpr double kMostSigmas = 5.0;

inline bool lies_at(const SpinEstimate& mean, const SpinFix& fix) {
  const double both_rad =
      std::hypot(testing::sigma_rad(mean), std::sqrt(fix.covariance_rad2.trace()));
  return angle_between_rad(mean.axis_icrf, fix.axis_icrf) < kMostSigmas * both_rad;
}

/// Expects each mean to lie at one of the fixes so far, and each OK mean at the true axis.
/// @return Number of OK means.
inline int check_every_mean(const SpinOutput& output, const Eigen::Vector3d& axis_icrf) {
  int ok = 0;
  std::vector<SpinFix> fixes;
  for (const SpinProduct& product : output.products) {
    if (const auto* const fix = std::get_if<SpinFix>(&product)) {
      if (fix->accepted && !fix->near_tangent) {
        fixes.push_back(*fix);
      }
    }
    const auto* const mean = std::get_if<SpinEstimate>(&product);
    if (mean == nullptr || mean->estimator != SpinEstimator::Mean) {
      continue;
    }
    EXPECT_TRUE(std::any_of(fixes.begin(), fixes.end(), [&](const SpinFix& fix) {
      return lies_at(*mean, fix);
    })) << sentence_of(mean->assessment);
    if (is_unopposed(mean->assessment.quality)) {
      ++ok;
      EXPECT_LT(angle_between_rad(mean->axis_icrf, axis_icrf), kMostSigmas * sigma_rad(*mean))
          << sentence_of(mean->assessment);
    }
  }
  return ok;
}

/// Checks passes in which the Earth enters or leaves the view of a beam, so that chords are short
/// and fixes few. Half of them lack sun2, which leaves two angles from one beam and no redundancy.
inline void check_passes_across_the_limb(std::uint64_t first_seed, int passes) {
  constexpr double kRevolutions = 300.0;
  int ok = 0;
  for (int pass = 0; pass < passes; ++pass) {
    std::mt19937_64 rng{first_seed + static_cast<std::uint64_t>(pass)};
    RandomPass drawn = pass_across_the_limb(rng);
    SCOPED_TRACE(std::to_string(pass) + ": " + drawn.name);
    if (pass % 2 == 0) {
      drawn.dead.push_back(PulseChannel::Sun2);
    }
    const double period_s = drawn.body.seconds_of(1.0);
    const DirtyPass received =
        dirty(drawn.pulses(kRevolutions, rng), period_s, {.lost = 0.03, .spoilt = 0.02}, rng);
    const SpinOutput output = run(SpinPass{drawn.body.config, drawn.orbit}, received.pulses);
    ok += check_every_mean(output, drawn.body.axis_icrf) > 0 ? 1 : 0;
  }
  ::testing::Test::RecordProperty("ok", ok);
  EXPECT_GT(ok, passes / 2);
}

}  // namespace spindrift::testing
