#include <gtest/gtest.h>

#include "tests/support/outcome.h"
#include "tests/support/rescue_trials.h"

namespace spindrift::testing::rescue_many_test {

/// From any attitude within an hour to within 6 deg, by the magnetometer alone.
TEST(RescueMany, NinetyFiveOfAHundredBodiesReachTheCommandedAttitude) {
  constexpr int kRuns = 100;
  int reached = 0;
  for (std::uint64_t seed = 0; seed < kRuns; ++seed) {
    const Rescue rescue = value_or_throw(rescued(tumbling_to_rescue(seed, 3'600.0), seed));
    const RescueOutcome outcome = outcome_of(rescue);
    EXPECT_FALSE(fires_while_lost(rescue)) << seed;
    EXPECT_LT(outcome.error_at_safe_rad.value_or(0.0), 15.0 * kRadPerDeg) << seed;
    reached += outcome.reached_s && outcome.last_off_rad < 6.0 * kRadPerDeg ? 1 : 0;
  }
  EXPECT_GE(reached, 95);
}

}  // namespace spindrift::testing::rescue_many_test
