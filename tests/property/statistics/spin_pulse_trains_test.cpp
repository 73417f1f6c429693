/// Doubled and halved pulse trains; property/long runs twenty times as many.

#include <gtest/gtest.h>

#include "tests/support/pulse_trains.h"

namespace spindrift::spin_pulse_trains_test {

TEST(SpinPulseTrains, DoubledAndHalvedOnesHaveTheirAxis) {
  testing::expect_the_axis_of(testing::plain_trains(), true, 1, 1);
}

TEST(SpinPulseTrains, NoneIsOkFarOff) {
  testing::expect_the_axis_of(testing::mixed_trains(), false, 1, 1);
}

}  // namespace spindrift::spin_pulse_trains_test
