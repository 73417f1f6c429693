/// With a wrong sensor model in the mission file, the filter reports it and its covariance covers
/// the error.

#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <random>

#include "pipelines/frames/angle.h"
#include "pipelines/spin/pass/spin_pass.h"
#include "tests/support/assessed.h"
#include "tests/support/observed_spin.h"
#include "tests/support/product_text.h"
#include "tests/support/spinning_body.h"

namespace spindrift::testing::spin_wrong_model_test {

constexpr double kEnd_s = 400.0;

struct Tally {
  int passes = 0;
  int doubted = 0;       ///< Passes whose last estimate is not trusted.
  int covered = 0;       ///< Passes whose last error is within three sigmas.
  int doubted_ever = 0;  ///< Passes with a DOUBTFUL or LOST revolution.
  int estimates = 0;
  int sure_and_wrong = 0;  ///< OK estimates with an error beyond three sigmas.
};

/// Runs passes of a body that differs from its mission file by `differ`.
Tally tally_of(int passes, const std::function<void(SpinConfig&)>& differ) {
  const Surroundings from;
  std::mt19937_64 rng{81};
  Tally tally;
  for (int pass = 0; pass < passes; ++pass) {
    SpinningBody body = random_body(from.around, 6.0 * kRadPerDeg, rng);
    const SpinConfig said = body.config;
    differ(body.config);
    const SpinOutput output = run(SpinPass{said, from.orbit}, from.pulses(body, 0.0, kEnd_s, rng));
    bool doubted = false;
    for (const SpinEstimate& estimate : estimates_of(output, SpinEstimator::Sequential)) {
      ++tally.estimates;
      doubted = doubted || estimate.assessment.quality == Quality::Doubtful ||
                estimate.assessment.quality == Quality::Lost;
      tally.sure_and_wrong +=
          is_unopposed(estimate.assessment.quality) && error_sigmas(estimate, body.axis_icrf) > 3.0
              ? 1
              : 0;
    }
    const SpinEstimate last = last_estimate(output, SpinEstimator::Sequential);
    ++tally.passes;
    tally.doubted_ever += doubted ? 1 : 0;
    tally.doubted += last.assessment.quality == Quality::Doubtful ? 1 : 0;
    tally.covered += error_sigmas(last, body.axis_icrf) < 3.0 ? 1 : 0;
  }
  for (const auto& [name, value] :
       {std::pair{"doubted", tally.doubted}, std::pair{"covered", tally.covered},
        std::pair{"doubted_ever", tally.doubted_ever}, std::pair{"estimates", tally.estimates},
        std::pair{"sure_and_wrong", tally.sure_and_wrong}}) {
    ::testing::Test::RecordProperty(name, value);
  }
  return tally;
}

TEST(SpinWrongModel, AHealthyPassIsNotDoubted) {
  const Tally tally = tally_of(200, [](SpinConfig&) {});
  EXPECT_LE(tally.doubted_ever, 2);
  EXPECT_LE(tally.sure_and_wrong, tally.estimates / 50);
}

TEST(SpinWrongModel, ABeamOffInAzimuthIsDoubtedAndCovered) {
  const Tally tally =
      tally_of(20, [](SpinConfig& body) { body.north->azimuth_rad += 1.0 * kRadPerDeg; });
  EXPECT_EQ(tally.doubted, tally.passes);
  EXPECT_GE(tally.covered, 19);
  EXPECT_LE(tally.sure_and_wrong, tally.estimates / 50);
}

TEST(SpinWrongModel, NoiseBeyondWhatIsStatedIsDoubtedThroughoutAndCovered) {
  for (const double times : {2.0, 5.0}) {
    SCOPED_TRACE(times);
    const Tally tally = tally_of(20, [times](SpinConfig& body) {
      body.noise.sun_s *= times;
      body.noise.infrared_s *= times;
    });
    EXPECT_EQ(tally.doubted, tally.passes);
    EXPECT_GE(tally.covered, 19);
    EXPECT_LE(tally.sure_and_wrong, tally.estimates / 100);
  }
}

/// Returns for how many of the seeds 1 to 10 the pass reports that model errors move its axis far.
int told_of_poor_leverage(const Orbit& orbit, SpinningBody body) {
  const auto around = seen_from(orbit);
  const auto edges = edges_between(body, around, 0.0, kEnd_s);
  int told = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    std::mt19937_64 rng{seed};
    const SpinOutput output = run(SpinPass{body.config, orbit}, noisy_pulses(body, edges, rng));
    told += has(output.notices, NoticeCode::LittleLeverage) ? 1 : 0;
  }
  return told;
}

TEST(SpinWrongModel, PoorLeverageIsToldByTheGeometryWhateverTheNoise) {
  SpinningBody body = body_across_the_earth();
  for (const double infrared_s : {5e-4, 2e-3}) {
    body.config.noise.infrared_s = infrared_s;
    EXPECT_EQ(told_of_poor_leverage(orbit_across_the_earth(), body), 10) << infrared_s;
  }
  std::mt19937_64 rng{81};
  const Surroundings from;
  EXPECT_EQ(told_of_poor_leverage(from.orbit, random_body(from.around, 6.0 * kRadPerDeg, rng)), 0);
}

}  // namespace spindrift::testing::spin_wrong_model_test
