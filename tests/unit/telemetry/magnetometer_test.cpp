#include "services/telemetry/magnetometer.h"

#include <limits>

#include "tests/support/telemetry_kind_checks.h"

namespace spindrift::magnetometer_test {

TEST(MagnetometerTelemetry, HasTheColumnsOfTheContract) {
  EXPECT_EQ(header_of<MagneticField>(), "t_tai_ns,bx_nt,by_nt,bz_nt");
  EXPECT_EQ(testing::value_of_row<MagneticField>("21000,-1200.5,0")->field_body_nt,
            Eigen::Vector3d(21000.0, -1200.5, 0.0));
}

TEST(MagnetometerTelemetry, RefusesWhatIsNoField) {
  testing::expect_refused<MagneticField>({
      {"0,0,0", "bx_nt, by_nt, bz_nt = 0, 0, 0: must be above 0, at most 100000 nT together"},
      {"0,100001,0", "must be above 0, at most 100000 nT together"},
      {"70000,70000,70000", "must be above 0, at most 100000 nT together"},
      {"0,0,nan", "bz_nt = \"nan\": must be a number"},
      {"1,,0", "by_nt = \"\": must be a number"},
  });
  EXPECT_TRUE(testing::value_of_row<MagneticField>("0,-100000,0"));
}

TEST(MagnetometerTelemetry, RefusesNanFromTheBus) {
  MagneticField sample;
  sample.field_body_nt.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(Telemetry<MagneticField>::why_impossible(sample), ::testing::HasSubstr("nan"));
}

}  // namespace spindrift::magnetometer_test
