#include "pipelines/ephemeris/earth_orientation.h"

#include <Eigen/Dense>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/rotation_vector.h"
#include "pipelines/time/utc.h"
#include "tests/support/matchers.h"

namespace spindrift::earth_orientation_test {

TEST(EarthOrientation, IsThatOfTheSofaCookbook) {
  // Source: SOFA Tools for Earth Attitude, 5.5, for 2007 April 5, 12h UTC. UT1 - UTC is
  // -0.072073685 s, by which the time is shifted here. The corrections dX and dY (0.3 mas) are
  // neglected.
  Eigen::Matrix3d R_itrf_icrf;
  R_itrf_icrf << +0.973104317697535, +0.230363826239128, -0.000703163482198,  //
      -0.230363800455689, +0.973104570632883, +0.000118545366625,             //
      +0.000711560162668, +0.000046626403995, +0.999999745754024;
  // Polar motion of the example, to first order.
  const double x_rad = 0.0349282 / 3600.0 * kRadPerDeg;
  const double y_rad = 0.4833163 / 3600.0 * kRadPerDeg;
  Eigen::Matrix3d R_itrf_intermediate;
  R_itrf_intermediate << 1.0, 0.0, x_rad, 0.0, 1.0, -y_rad, -x_rad, y_rad, 1.0;

  const TaiTime t = shifted(parse_utc("2007-04-05T12:00:00").value(), -0.072073685);
  const Eigen::Matrix3d R_intermediate_icrf = earth_orientation(t).conjugate().toRotationMatrix();
  EXPECT_NEAR((R_itrf_intermediate * R_intermediate_icrf - R_itrf_icrf).cwiseAbs().maxCoeff(), 0.0,
              2e-9);
}

TEST(EarthOrientation, TurnsOnceASiderealDayAcrossALeapSecond) {
  // A leap second at the end of 2016 makes 24 h of UTC 86,401 s long, which is one UT1 day.
  const TaiTime before = parse_utc("2016-12-31T12:00:00").value();
  const TaiTime after = parse_utc("2017-01-01T12:00:00").value();
  ASSERT_EQ(seconds_between(before, after), 86401.0);
  const Eigen::Quaterniond turned =
      earth_orientation(before).conjugate() * earth_orientation(after);
  // The Earth rotation angle (IERS Conventions 2010, eq. 5.15) grows by a turn and this much in a
  // UT1 day.
  constexpr double kMore_rad = 0.00273781191135448 * kTurn_rad;
  EXPECT_NEAR(Eigen::AngleAxisd{turned}.angle(), kMore_rad, 1e-6);
}

TEST(TurningEarth, IsTheExactOrientation) {
  constexpr double k20Mas_rad = 0.02 / 3600.0 * kRadPerDeg;
  TurningEarth earth;
  const TaiTime start = parse_utc("2026-03-01T00:00:00").value();
  for (double t_s = -90'000.0; t_s < 90'000.0; t_s += 777.7) {
    const TaiTime t = shifted(start, t_s);
    EXPECT_LT(angle_between_rad(earth.orientation(t), earth_orientation(t)), k20Mas_rad) << t_s;
  }
}

TEST(TurningEarth, IsTheSameBitForBitWhateverWasAskedBefore) {
  const TaiTime t = parse_utc("2026-03-01T03:45:12.5").value();
  TurningEarth fresh;
  TurningEarth used;
  static_cast<void>(used.orientation(shifted(t, -600.0)));
  static_cast<void>(used.orientation(shifted(t, 86'400.0)));
  EXPECT_EQ(used.orientation(t).coeffs(), fresh.orientation(t).coeffs());
}

}  // namespace spindrift::earth_orientation_test
