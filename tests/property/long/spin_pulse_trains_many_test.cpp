#include <gtest/gtest.h>

#include "tests/support/pulse_trains.h"

namespace spindrift::spin_pulse_trains_many_test {

TEST(SpinPulseTrainsMany, DoubledAndHalvedOnesHaveTheirAxis) {
  testing::expect_the_axis_of(testing::plain_trains(), true, 2, 20);
}

TEST(SpinPulseTrainsMany, NoneIsOkFarOff) {
  testing::expect_the_axis_of(testing::mixed_trains(), false, 2, 20);
}

}  // namespace spindrift::spin_pulse_trains_many_test
