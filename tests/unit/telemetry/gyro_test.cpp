#include "services/telemetry/gyro.h"

#include <limits>

#include "tests/support/telemetry_kind_checks.h"

namespace spindrift::gyro_test {

TEST(GyroTelemetry, HasTheColumnsOfTheContract) {
  EXPECT_EQ(header_of<GyroSample>(), "t_tai_ns,wx_rad_s,wy_rad_s,wz_rad_s");
  const GyroSample sample = testing::value_of_row<GyroSample>("1.5e-2,-2,0").value();
  EXPECT_EQ(sample.t, tai_from_ns(1772337697000000000));
  EXPECT_EQ(sample.rate_body_rad_s, Eigen::Vector3d(0.015, -2.0, 0.0));
}

TEST(GyroTelemetry, ABodyAtRestIsNoError) {
  EXPECT_TRUE(testing::value_of_row<GyroSample>("0,0,0"));
}

TEST(GyroTelemetry, RefusesWhatIsNoRate) {
  testing::expect_refused<GyroSample>({
      {",0,0", "wx_rad_s = \"\": must be a number"},
      {"0,nan,0", "wy_rad_s = \"nan\": must be a number"},
      {"0,0,inf", "wz_rad_s = \"inf\": must be a number"},
      {"0,0,1e-3x", "wz_rad_s = \"1e-3x\": must be a number"},
      {"0,0,17.46", "wx_rad_s, wy_rad_s, wz_rad_s = 0, 0, 17.46: must be at most 1000 deg/s"},
      {"11,11,11", "must be at most 1000 deg/s together"},
  });
  EXPECT_TRUE(testing::value_of_row<GyroSample>("0,0,17.45"));
}

TEST(GyroTelemetry, RefusesNanFromTheBus) {
  GyroSample sample;
  sample.rate_body_rad_s.y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(Telemetry<GyroSample>::why_impossible(sample), ::testing::HasSubstr("0, nan, 0"));
}

}  // namespace spindrift::gyro_test
