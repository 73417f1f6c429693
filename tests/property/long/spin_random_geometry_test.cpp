/// Errors over passes of random geometry, case and spin rate (tests/support/random_pass.h) are
/// consistent with their covariances.

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>

#include "pipelines/spin/pass/spin_pass.h"
#include "services/base/assessment_words.h"
#include "tests/support/observed_spin.h"
#include "tests/support/product_text.h"
#include "tests/support/random_pass.h"

namespace spindrift::testing::spin_random_geometry_test {

constexpr double kRevolutions = 150.0;

TEST(SpinRandomGeometry, MeansLieWithinWhatTheyPromise) {
  constexpr int kPasses = 200;
  double squares = 0.0;
  double worst = 0.0;
  int means = 0;
  int selected = 0;
  for (int pass = 0; pass < kPasses; ++pass) {
    std::mt19937_64 rng{static_cast<std::uint64_t>(pass)};
    const RandomPass drawn = random_pass(rng);
    SCOPED_TRACE(std::to_string(pass) + ": " + drawn.name);
    const SpinOutput output =
        run(SpinPass{drawn.body.config, drawn.orbit}, drawn.pulses(kRevolutions, rng));
    const auto estimates = estimates_of(output, SpinEstimator::Mean);
    if (estimates.empty()) {
      continue;  // The ambiguity was not resolved in this pass.
    }
    const SpinEstimate& mean = estimates.back();
    const double squared = squared_error(mean, drawn.body.axis_icrf);
    // Each has a probability of e^-9 = 1 in 8000.
    EXPECT_LT(squared, 18.0) << sentence_of(mean.assessment);
    squares += squared;
    worst = std::max(worst, squared);
    const bool is_selection = has(mean.assessment, ReasonCode::FewSettled);
    EXPECT_TRUE(is_selection || mean.assessment.quality != Quality::Doubtful)
        << sentence_of(mean.assessment);
    selected += is_selection ? 1 : 0;
    ++means;
  }
  RecordProperty("means", means);
  RecordProperty("selected", selected);
  RecordProperty("mean_square", std::to_string(squares / (2.0 * means)));
  RecordProperty("worst", std::to_string(worst));
  EXPECT_GT(means, kPasses * 3 / 4);
  EXPECT_LE(selected, kPasses / 20);
  // Chi-square with 2 n degrees of freedom over 2 n has mean 1 and variance 1/n. The limits are
  // four sigma above and five below, where fixes with unresolved ambiguity widen the covariance.
  EXPECT_LT(squares / (2.0 * means), 1.0 + 4.0 / std::sqrt(means));
  EXPECT_GT(squares / (2.0 * means), 1.0 - 5.0 / std::sqrt(means));
}

}  // namespace spindrift::testing::spin_random_geometry_test
