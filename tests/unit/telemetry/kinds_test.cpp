// The traits of the kinds that have a table of columns alone: what a row and a sample must be.

#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "services/telemetry/csv.h"
#include "services/telemetry/gyro.h"
#include "services/telemetry/magnetometer.h"
#include "services/telemetry/orbit_state.h"
#include "services/telemetry/parse_row.h"
#include "services/telemetry/star.h"
#include "services/telemetry/sun.h"
#include "services/telemetry/telemetry_layout.h"
#include "tests/support/matchers.h"

namespace spindrift::kinds_test {

using Eigen::Vector3d;

struct BadFields {
  std::string_view row;
  const char* reason;
};

/// Parses a CSV row with a valid time in front of it.
template <class Value>
Expected<Value> value_of_row(std::string_view row) {
  const std::string line = "1772337697000000000," + std::string{row};
  Value value;
  return parse_row(CsvFields{line}.fields(), value).map([&value] { return value; });
}

template <class Value>
void expect_refused(const std::vector<BadFields>& rows) {
  for (const BadFields& bad : rows) {
    SCOPED_TRACE(bad.row);
    EXPECT_THAT(value_of_row<Value>(bad.row),
                IsRefused(ErrorCode::InvalidInput, HasSubstr(bad.reason)));
  }
}

TEST(KindOfTelemetry, HasTheColumnsOfTheContract) {
  EXPECT_EQ(header_of<GyroSample>(), "t_tai_ns,wx_rad_s,wy_rad_s,wz_rad_s");
  const GyroSample gyro = value_of_row<GyroSample>("1.5e-2,-2,0").value();
  EXPECT_EQ(gyro.t, tai_from_ns(1772337697000000000));
  EXPECT_EQ(gyro.rate_body_rad_s, Vector3d(0.015, -2.0, 0.0));
  EXPECT_EQ(header_of<MagneticField>(), "t_tai_ns,bx_nt,by_nt,bz_nt");
  EXPECT_EQ(value_of_row<MagneticField>("21000,-1200.5,0")->field_body_nt,
            Vector3d(21000.0, -1200.5, 0.0));
  EXPECT_EQ(header_of<TimedOrbitState>(), "t_tai_ns,x_km,y_km,z_km,vx_km_s,vy_km_s,vz_km_s");
  const auto orbit = value_of_row<TimedOrbitState>("7000,0,1,0,7.5,-0.5").value().state;
  EXPECT_EQ(orbit.position_icrf_km, Vector3d(7000.0, 0.0, 1.0));
  EXPECT_EQ(orbit.velocity_icrf_km_s, Vector3d(0.0, 7.5, -0.5));
  EXPECT_EQ(header_of<StarFix>(), "t_tai_ns,qx,qy,qz,qw");
  const auto q = value_of_row<StarFix>("0.5,-0.5,0.5,0.5").value().q_icrf_sensor;
  EXPECT_EQ(q.coeffs(), Eigen::Vector4d(0.5, -0.5, 0.5, 0.5));
  EXPECT_EQ(q.w(), 0.5);
  EXPECT_EQ(header_of<SunDirection>(), "t_tai_ns,sx,sy,sz");
  EXPECT_EQ(value_of_row<SunDirection>("0.6,0,-0.8")->sun_body, Vector3d(0.6, 0.0, -0.8));
}

TEST(KindOfTelemetry, TakesWhatIsOnTheEdgeOfPossible) {
  EXPECT_TRUE(value_of_row<GyroSample>("0,0,0"));
  EXPECT_TRUE(value_of_row<GyroSample>("0,0,17.45"));
  EXPECT_TRUE(value_of_row<MagneticField>("0,-100000,0"));
  EXPECT_TRUE(value_of_row<SunDirection>("0,-1.0009,0"));
  EXPECT_TRUE(value_of_row<StarFix>("0,0,-0.9991,0"));
  // A length that is off by little stays as it was received.
  EXPECT_EQ(value_of_row<StarFix>("0,0,0,1.0009")->q_icrf_sensor.w(), 1.0009);
}

TEST(KindOfTelemetry, RefusesWhatCannotBe) {
  expect_refused<GyroSample>({
      {",0,0", "wx_rad_s = \"\": must be a number"},
      {"0,nan,0", "wy_rad_s = \"nan\": must be a number"},
      {"0,0,inf", "wz_rad_s = \"inf\": must be a number"},
      {"0,0,1e-3x", "wz_rad_s = \"1e-3x\": must be a number"},
      {"0,0,17.46", "wx_rad_s, wy_rad_s, wz_rad_s = 0, 0, 17.46: must be at most 1000 deg/s"},
      {"11,11,11", "must be at most 1000 deg/s together"},
  });
  expect_refused<MagneticField>({
      {"0,0,0", "bx_nt, by_nt, bz_nt = 0, 0, 0: must be above 0, at most 100000 nT together"},
      {"0,100001,0", "must be above 0, at most 100000 nT together"},
      {"70000,70000,70000", "must be above 0, at most 100000 nT together"},
      {"0,0,nan", "bz_nt = \"nan\": must be a number"},
      {"1,,0", "by_nt = \"\": must be a number"},
  });
  expect_refused<TimedOrbitState>({
      {"0,0,0,0,7.5,0", "x_km, y_km, z_km = 0, 0, 0: must be 6300 to 2000000 km"},
      {"6299,0,0,0,7.5,0", "must be 6300 to 2000000 km from the centre of the Earth"},
      {"0,0,2000001,0,7.5,0", "must be 6300 to 2000000 km"},
      {"7000,0,0,0,0,0", "vx_km_s, vy_km_s, vz_km_s = 0, 0, 0: must be above 0, at most 20 km/s"},
      {"7000,0,0,0,20.1,0", "must be above 0, at most 20 km/s"},
      {"7000,0,0,0,7.5,", "vz_km_s = \"\": must be a number"},
  });
  expect_refused<StarFix>({
      {"0,0,0,0", "qx, qy, qz, qw = 0, 0, 0, 0: must have length 1 within 0.001"},
      {"0,0,0,1.0011", "must have length 1 within 0.001"},
      {"0,0,0.9989,0", "must have length 1 within 0.001"},
      {"0,0,0,1e200", "must have length 1 within 0.001"},
      {"0,0,0,nan", "qw = \"nan\": must be a number"},
      {"0,,0,1", "qy = \"\": must be a number"},
  });
  expect_refused<SunDirection>({
      {"0,0,0", "sx, sy, sz = 0, 0, 0: must have length 1 within 0.001"},
      {"0,1.0011,0", "must have length 1 within 0.001"},
      {"0.9989,0,0", "must have length 1 within 0.001"},
      {"-inf,0,0", "sx = \"-inf\": must be a number"},
  });
}

template <class Value>
std::string why_impossible(const Value& value) {
  return Telemetry<Value>::why_impossible(value);
}

TEST(KindOfTelemetry, RefusesNanFromTheBus) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(why_impossible(GyroSample{.t = {}, .rate_body_rad_s = {0.0, kNan, 0.0}}),
              HasSubstr("0, nan, 0"));
  EXPECT_THAT(why_impossible(MagneticField{.t = {}, .field_body_nt = {kNan, 0.0, 0.0}}),
              HasSubstr("nan"));
  EXPECT_THAT(why_impossible(SunDirection{.t = {}, .sun_body = {0.0, 0.0, kNan}}),
              HasSubstr("nan"));
  EXPECT_THAT(why_impossible(StarFix{.t = {}, .q_icrf_sensor = {1.0, kNan, 0.0, 0.0}}),
              HasSubstr("nan, 0, 0, 1"));
  auto orbit = value_of_row<TimedOrbitState>("7000,0,0,0,7.5,0").value();
  orbit.state.velocity_icrf_km_s.x() = kNan;
  EXPECT_THAT(why_impossible(orbit), HasSubstr("vx_km_s"));
  orbit.state.position_icrf_km.x() = kNan;
  EXPECT_THAT(why_impossible(orbit), HasSubstr("x_km"));
}

}  // namespace spindrift::kinds_test
