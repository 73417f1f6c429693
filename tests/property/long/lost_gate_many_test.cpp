#include <gtest/gtest.h>

#include "tests/support/lost_gate_trials.h"

namespace spindrift::testing::lost_gate_many_test {

TEST(LostGateMany, NoFalseAlarmInAThousandOrbits) {
  constexpr int kOrbits = 1'000;
  constexpr int kAtOnce = 20;  ///< Orbits of a pass.
  for (std::uint64_t seed = 0; seed < kOrbits / kAtOnce; ++seed) {
    ASSERT_EQ(LostGateTrial{1'000 + seed}.transitions(kAtOnce * kRevolution_s), 0) << seed;
  }
}

TEST(LostGateMany, AThousandDeparturesAreDeclaredWithinTwoWindows) {
  LostGateTrial trial{7};
  for (int i = 0; i < 1'000; ++i) {
    ASSERT_EQ(trial.transitions(200 + i % 37), 0) << i;
    ASSERT_LE(trial.delay(10.0), 2 * rule_of(Gate::Lost).samples) << i;
    // The gate closes by the windows behind the end of the departure.
    ASSERT_EQ(trial.transitions(50), 1) << i;
  }
}

}  // namespace spindrift::testing::lost_gate_many_test
