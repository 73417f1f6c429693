#include "services/telemetry/star.h"

#include <limits>

#include "tests/support/telemetry_kind_checks.h"

namespace spindrift::star_test {

TEST(StarTelemetry, HasTheColumnsOfTheContract) {
  EXPECT_EQ(header_of<StarFix>(), "t_tai_ns,qx,qy,qz,qw");
  const StarFix fix = testing::value_of_row<StarFix>("0.5,-0.5,0.5,0.5").value();
  EXPECT_EQ(fix.q_icrf_sensor.coeffs(), Eigen::Vector4d(0.5, -0.5, 0.5, 0.5));
  EXPECT_EQ(fix.q_icrf_sensor.w(), 0.5);
}

TEST(StarTelemetry, KeepsALengthThatIsOffByLittleAsItWasReceived) {
  for (const char* row : {"0,0,0,1.0009", "0,0,-0.9991,0"}) {
    EXPECT_TRUE(testing::value_of_row<StarFix>(row)) << row;
  }
  EXPECT_EQ(testing::value_of_row<StarFix>("0,0,0,1.0009")->q_icrf_sensor.w(), 1.0009);
}

TEST(StarTelemetry, RefusesWhatIsNoRotation) {
  testing::expect_refused<StarFix>({
      {"0,0,0,0", "qx, qy, qz, qw = 0, 0, 0, 0: must have length 1 within 0.001"},
      {"0,0,0,1.0011", "must have length 1 within 0.001"},
      {"0,0,0.9989,0", "must have length 1 within 0.001"},
      {"0,0,0,1e200", "must have length 1 within 0.001"},
      {"0,0,0,nan", "qw = \"nan\": must be a number"},
      {"0,,0,1", "qy = \"\": must be a number"},
  });
}

TEST(StarTelemetry, RefusesNanFromTheBus) {
  StarFix fix;
  fix.q_icrf_sensor.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(Telemetry<StarFix>::why_impossible(fix), ::testing::HasSubstr("nan, 0, 0, 1"));
}

}  // namespace spindrift::star_test
