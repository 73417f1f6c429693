#include <numbers>

#include "pipelines/ephemeris/earth_orientation.h"
#include "pipelines/time/utc.h"
#include "tests/support/matchers.h"

namespace spindrift::earth_pole_test {

constexpr double kArcsec_rad = std::numbers::pi / 180.0 / 3600.0;

TEST(EarthPole, AtJ2000ItIsThePoleButForTheFrameBias) {
  // IERS Conventions 2010, 5.4.4: the mean pole at J2000.0 is at xi0 = -16.617 mas, eta0 = -6.819
  // mas.
  const Eigen::Vector3d pole = earth_pole_icrf(parse_utc("2000-01-01T11:58:55.816").value());
  EXPECT_NEAR(pole.x(), -0.016617 * kArcsec_rad, 1e-5 * kArcsec_rad);
  EXPECT_NEAR(pole.y(), -0.006819 * kArcsec_rad, 1e-5 * kArcsec_rad);
}

TEST(EarthPole, MovesAsPrecessionSays) {
  // IERS Conventions 2010, eq. 5.16, the polynomials; t in Julian centuries of TT.
  const double t = 0.25;
  const double x_arcsec = -0.016617 + 2004.191898 * t - 0.4297829 * t * t - 0.19861834 * t * t * t;
  const double y_arcsec = -0.006951 - 0.025896 * t - 22.4072747 * t * t + 0.00190059 * t * t * t;
  // J2000 plus 9131.25 days is 2024-12-31T18:00:00 TT, 69.184 s ahead of UTC.
  const Eigen::Vector3d pole = earth_pole_icrf(parse_utc("2024-12-31T17:58:50.816").value());
  EXPECT_NEAR(pole.x(), x_arcsec * kArcsec_rad, 2e-3 * kArcsec_rad);
  EXPECT_NEAR(pole.y(), y_arcsec * kArcsec_rad, 2e-3 * kArcsec_rad);
  EXPECT_NEAR(pole.norm(), 1.0, 1e-15);
}

}  // namespace spindrift::earth_pole_test
