/// Doubled and halved pulse trains; property/long runs twenty times as many.

#include <gtest/gtest.h>

#include "tests/support/pulse_trains.h"

namespace spindrift::testing::spin_pulse_trains_test {

TEST(SpinPulseTrains, DoubledAndHalvedOnesHaveTheirAxis) {
  expect_the_axis_of(plain_trains(), true, 1, 1);
}

TEST(SpinPulseTrains, NoneIsOkFarOff) { expect_the_axis_of(mixed_trains(), false, 1, 1); }

}  // namespace spindrift::testing::spin_pulse_trains_test
