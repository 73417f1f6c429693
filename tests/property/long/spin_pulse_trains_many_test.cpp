#include <gtest/gtest.h>

#include "tests/support/pulse_trains.h"

namespace spindrift::testing::spin_pulse_trains_many_test {

TEST(SpinPulseTrainsMany, DoubledAndHalvedOnesHaveTheirAxis) {
  expect_the_axis_of(plain_trains(), true, 2, 20);
}

TEST(SpinPulseTrainsMany, NoneIsOkFarOff) { expect_the_axis_of(mixed_trains(), false, 2, 20); }

}  // namespace spindrift::testing::spin_pulse_trains_many_test
