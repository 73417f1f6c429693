/// The first estimates of a pass rest on little data: no wrong one may be OK, whatever the body
/// does and whatever the mission file has wrong.

#include <gtest/gtest.h>

#include <functional>

#include "pipelines/frames/angle.h"
#include "pipelines/spin/pass/spin_pass.h"
#include "tests/support/product_text.h"
#include "tests/support/wobbling_pass.h"

namespace spindrift::testing::spin_first_rows_test {

constexpr int kPasses = 20;
constexpr double kDuration_s = 100.0;
constexpr double kMostSigmas = 5.0;

struct Tally {
  int converging = 0;
  int ok = 0;
  int ok_and_wrong = 0;  ///< OK estimates beyond five sigmas.
  int passes_wrong = 0;  ///< Passes with such estimates.
};

void count(const SpinEstimate& estimate, const SpinTruth& truth, Tally& tally) {
  tally.converging += estimate.assessment.quality == Quality::Converging ? 1 : 0;
  if (estimate.assessment.quality == Quality::Ok) {
    ++tally.ok;
    tally.ok_and_wrong +=
        squared_error(estimate, truth.motion.axis_icrf) > kMostSigmas * kMostSigmas ? 1 : 0;
  }
}

/// Runs passes in which `differ` changes body and mission.
Tally tally_of(const std::function<void(WobblingPasses&, SpinTruth&)>& differ) {
  WobblingPasses passes{2025, kDuration_s};
  Tally tally;
  for (int pass = 0; pass < kPasses; ++pass) {
    SpinTruth truth = passes.drawn();
    differ(passes, truth);
    const SpinOutput output = run(SpinPass{passes.config(), passes.orbit()}, passes.pulses(truth));
    const int wrong_before = tally.ok_and_wrong;
    for (const SpinEstimate& estimate : all_of<SpinEstimate>(output)) {
      count(estimate, truth, tally);
    }
    tally.passes_wrong += tally.ok_and_wrong > wrong_before ? 1 : 0;
  }
  ::testing::Test::RecordProperty("converging", tally.converging);
  ::testing::Test::RecordProperty("ok", tally.ok);
  return tally;
}

TEST(SpinFirstRows, OfAHealthyPassConvergeAndAreThenOk) {
  const Tally tally = tally_of([](auto&, auto&) {});
  EXPECT_GT(tally.converging, 0);
  EXPECT_GT(tally.ok, tally.converging);
  EXPECT_EQ(tally.ok_and_wrong, 0);
}

TEST(SpinFirstRows, AreNotOkAndWrongWhereTheBodyNutatesOrOneBeamCrossesTheMiddle) {
  const auto nutating = [](WobblingPasses& passes, SpinTruth& truth) {
    truth.motion.nutation = passes.random_nutation((0.1 + 2.9 * passes.uniform()) * kRadPerDeg);
  };
  const auto one_beam = [](WobblingPasses& passes, SpinTruth& truth) {
    truth.south.reset();
    passes.config().south.reset();
  };
  for (const Tally& tally : {tally_of(nutating), tally_of(one_beam)}) {
    EXPECT_GT(tally.converging, 0);
    EXPECT_EQ(tally.ok_and_wrong, 0);
  }
}

TEST(SpinFirstRows, AreNotOkAndWrongWhereSensorsAreGrosslyMisplaced) {
  const Tally tally = tally_of([](WobblingPasses& passes, SpinTruth& truth) {
    const auto up_to_two_deg = [&] { return (4.0 * passes.uniform() - 2.0) * kRadPerDeg; };
    truth.north->mount_angle_rad += up_to_two_deg();
    truth.north->azimuth_rad += up_to_two_deg();
    truth.south->mount_angle_rad += up_to_two_deg();
  });
  EXPECT_GT(tally.converging, 0);
  // The error is twenty times the allowance of the mission file; one pass in twenty just exceeds
  // five sigmas.
  EXPECT_LE(tally.passes_wrong, 1);
}

}  // namespace spindrift::testing::spin_first_rows_test
