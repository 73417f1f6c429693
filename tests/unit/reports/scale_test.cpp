#include "services/reports/scale.h"

#include "tests/support/matchers.h"

namespace spindrift::plot::scale_test {

using ::testing::DoubleNear;

TEST(Scale, PutsValuesInProportion) {
  const Scale linear = Scale::linear(10.0, 20.0, 100.0, 300.0);
  EXPECT_DOUBLE_EQ(linear.pixel_of(15.0), 200.0);
  const Scale logarithmic = Scale::logarithmic(0.01, 100.0, 400.0, 0.0);
  EXPECT_DOUBLE_EQ(logarithmic.pixel_of(1.0), 200.0);
}

TEST(Scale, KeepsWhatLiesBeyondAtTheEnd) {
  const Scale logarithmic = Scale::logarithmic(0.01, 100.0, 400.0, 0.0);
  EXPECT_EQ(logarithmic.pixel_of(1e9), 0.0);
  EXPECT_EQ(logarithmic.pixel_of(0.0), 400.0);
}

TEST(Scale, TicksAreRoundNumbers) {
  EXPECT_THAT(linear_ticks(0.0, 57.0, 5), ElementsAre(0.0, 20.0, 40.0));
  EXPECT_THAT(
      linear_ticks(-0.3, 0.3, 6),
      ElementsAre(DoubleNear(-0.3, 1e-12), DoubleNear(-0.2, 1e-12), DoubleNear(-0.1, 1e-12), 0.0,
                  DoubleNear(0.1, 1e-12), DoubleNear(0.2, 1e-12), DoubleNear(0.3, 1e-12)));
  EXPECT_THAT(decades(0.001, 1.0), ElementsAre(DoubleNear(1e-3, 1e-15), DoubleNear(1e-2, 1e-15),
                                               DoubleNear(0.1, 1e-15), 1.0));
  EXPECT_THAT(decades(0.2, 0.8), IsEmpty());
}

TEST(Scale, TimeIsCountedAsPeopleDo) {
  EXPECT_EQ(time_step_s(0.2), 1.0);
  EXPECT_EQ(time_step_s(10.0), 10.0);
  EXPECT_EQ(time_step_s(11.0), 15.0);
  EXPECT_EQ(time_step_s(61.0), 120.0);
  EXPECT_EQ(time_step_s(1320.0), 1800.0);
  EXPECT_EQ(time_step_s(50'000.0), 86'400.0);
  EXPECT_EQ(time_step_s(90'000.0), 172'800.0);
}

}  // namespace spindrift::plot::scale_test
