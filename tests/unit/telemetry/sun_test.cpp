#include "services/telemetry/sun.h"

#include <limits>

#include "tests/support/telemetry_kind_checks.h"

namespace spindrift::sun_test {

TEST(SunTelemetry, HasTheColumnsOfTheContract) {
  EXPECT_EQ(header_of<SunDirection>(), "t_tai_ns,sx,sy,sz");
  EXPECT_EQ(testing::value_of_row<SunDirection>("0.6,0,-0.8")->sun_body,
            Eigen::Vector3d(0.6, 0.0, -0.8));
}

TEST(SunTelemetry, RefusesWhatIsNoUnitVector) {
  testing::expect_refused<SunDirection>({
      {"0,0,0", "sx, sy, sz = 0, 0, 0: must have length 1 within 0.001"},
      {"0,1.0011,0", "must have length 1 within 0.001"},
      {"0.9989,0,0", "must have length 1 within 0.001"},
      {"-inf,0,0", "sx = \"-inf\": must be a number"},
  });
  EXPECT_TRUE(testing::value_of_row<SunDirection>("0,-1.0009,0"));
}

TEST(SunTelemetry, RefusesNanFromTheBus) {
  SunDirection sample;
  sample.sun_body.z() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(Telemetry<SunDirection>::why_impossible(sample), ::testing::HasSubstr("nan"));
}

}  // namespace spindrift::sun_test
