#include "services/telemetry/orbit_state.h"

#include <limits>

#include "tests/support/telemetry_kind_checks.h"

namespace spindrift::orbit_state_test {

TEST(OrbitStateTelemetry, HasTheColumnsOfTheContract) {
  EXPECT_EQ(header_of<TimedOrbitState>(), "t_tai_ns,x_km,y_km,z_km,vx_km_s,vy_km_s,vz_km_s");
  const auto sample = testing::value_of_row<TimedOrbitState>("7000,0,1,0,7.5,-0.5").value();
  EXPECT_EQ(sample.state.position_icrf_km, Eigen::Vector3d(7000.0, 0.0, 1.0));
  EXPECT_EQ(sample.state.velocity_icrf_km_s, Eigen::Vector3d(0.0, 7.5, -0.5));
}

TEST(OrbitStateTelemetry, RefusesWhatIsNoOrbit) {
  testing::expect_refused<TimedOrbitState>({
      {"0,0,0,0,7.5,0", "x_km, y_km, z_km = 0, 0, 0: must be 6300 to 2000000 km"},
      {"6299,0,0,0,7.5,0", "must be 6300 to 2000000 km from the centre of the Earth"},
      {"0,0,2000001,0,7.5,0", "must be 6300 to 2000000 km"},
      {"7000,0,0,0,0,0", "vx_km_s, vy_km_s, vz_km_s = 0, 0, 0: must be above 0, at most 20 km/s"},
      {"7000,0,0,0,20.1,0", "must be above 0, at most 20 km/s"},
      {"7000,0,0,0,7.5,", "vz_km_s = \"\": must be a number"},
  });
}

TEST(OrbitStateTelemetry, RefusesNanFromTheBus) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  auto sample = testing::value_of_row<TimedOrbitState>("7000,0,0,0,7.5,0").value();
  sample.state.velocity_icrf_km_s.x() = kNan;
  EXPECT_THAT(Telemetry<TimedOrbitState>::why_impossible(sample), ::testing::HasSubstr("vx_km_s"));
  sample.state.position_icrf_km.x() = kNan;
  EXPECT_THAT(Telemetry<TimedOrbitState>::why_impossible(sample), ::testing::HasSubstr("x_km"));
}

}  // namespace spindrift::orbit_state_test
