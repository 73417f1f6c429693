// The lost gate on one orbit and a few departures; long/lost_gate_many_test.cpp has a thousand.

#include <gtest/gtest.h>

#include "tests/support/lost_gate_trials.h"

namespace spindrift::testing::lost_gate_test {

TEST(LostGate, IsNotOpenedByPointingErrorAndNoise) {
  EXPECT_EQ(LostGateTrial{1}.transitions(kRevolution_s), 0);
}

TEST(LostGate, OpensWithinTwoWindowsOfADeparture) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    LostGateTrial trial{seed};
    ASSERT_EQ(trial.transitions(50), 0);
    EXPECT_LE(trial.delay(10.0), 2 * rule_of(Gate::Lost).samples) << seed;
  }
}

}  // namespace spindrift::testing::lost_gate_test
