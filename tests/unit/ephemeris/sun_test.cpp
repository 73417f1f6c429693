#include "pipelines/ephemeris/sun.h"

#include <erfa.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "pipelines/frames/angle.h"
#include "pipelines/time/utc.h"
#include "tests/support/matchers.h"
#include "tests/support/test_paths.h"

namespace spindrift::sun_test {

constexpr double kAu_km = 149'597'870.7;
constexpr double kLight_km_s = 299'792.458;
constexpr double kArcsec_rad = std::numbers::pi / 180.0 / 3600.0;
constexpr double kTtMinusTai_s = 32.184;
constexpr double kDay_s = 86'400.0;

const OrbitState kEarthCentre{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};

TaiTime tai_of_jd_tt(double days_since_2440587_5) {
  return shifted(TaiTime{}, days_since_2440587_5 * kDay_s - kTtMinusTai_s);
}

double angle_rad(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

TaiTime random_time(std::mt19937_64& rng) {
  std::uniform_int_distribution<std::int64_t> any_ns{
      tai_ns(parse_utc("1990-01-01T00:00:00").value()),
      tai_ns(parse_utc("2040-01-01T00:00:00").value())};
  return tai_from_ns(any_ns(rng));
}

TEST(Sun, LiesWhereDe441PutsIt) {
  // eraEpv00, note 4: the heliocentric position is within 11.2 km of DE405 from 1900 to 2100. DE405
  // and DE441 differ by less than 2 km here, TT and TDB by 1.7 ms (0.05 km).
  constexpr double kTolerance_km = 11.2 + 2.0;
  std::ifstream file{test_data() / "sun" / "sun_geocentric_geometric_ICRF_DE441.csv"};
  std::string row;
  ASSERT_TRUE(std::getline(file, row));
  int rows = 0;
  while (std::getline(file, row)) {
    std::ranges::replace(row, ',', ' ');
    std::istringstream fields{row};
    double jd_tdb = 0.0;
    Eigen::Vector3d sun_au;
    ASSERT_TRUE(fields >> jd_tdb >> sun_au.x() >> sun_au.y() >> sun_au.z()) << row;
    const Eigen::Vector3d sun_km = geometric_sun_icrf_km(tai_of_jd_tt(jd_tdb - 2440587.5));
    EXPECT_LT((sun_km - kAu_km * sun_au).norm(), kTolerance_km) << jd_tdb;
    ++rows;
  }
  EXPECT_EQ(rows, 400);
}

TEST(Sun, EarthMovesAsErfasOwnTestSays) {
  // Source: liberfa 1d9738be, t_epv00 at TDB 2400000.5 + 53411.52501161. Its tolerance of 1e-14 au
  // is replaced by the resolution of TAI, 0.5 ns at 30 km/s.
  const EarthMotion earth = earth_motion(tai_of_jd_tt(53411.52501161 - 40587.0));
  const Eigen::Vector3d position_au{-0.7757238809297706, 0.559805224136334, 0.2426998466481687};
  const Eigen::Vector3d velocity_au_d{-0.010918918241473138, -0.01247187268440845,
                                      -0.005407569418065039};
  EXPECT_LT((earth.heliocentric_icrf_km - kAu_km * position_au).norm(), 1e-4);
  EXPECT_LT((earth.heliocentric_icrf_km_s - kAu_km / kDay_s * velocity_au_d).norm(), 1e-10);
}

TEST(ApparentSun, StandsWhereMeeusPutsIt) {
  // Source: Meeus, Astronomical Algorithms, example 25: 1992 October 13, 0 h TD, apparent place of
  // date by the complete VSOP87, 13h13m30.749s, -7 deg 47' 01.74". Rounding of the text: 0.01 s of
  // time is 0.15 arcsec.
  const TaiTime t = shifted(parse_tai("1992-10-13T00:00:00").value(), -kTtMinusTai_s);
  ApparentSun sun;
  Eigen::Vector3d icrf = sun.direction_icrf(t, kEarthCentre);
  double of_date_from_icrf[3][3];  // NOLINT(*-avoid-c-arrays): ERFA's own type.
  eraPnm06a(2448908.5, 0.0, of_date_from_icrf);
  Eigen::Vector3d of_date;
  eraRxp(of_date_from_icrf, icrf.data(), of_date.data());
  const double ra_rad = std::atan2(of_date.y(), of_date.x()) + 2.0 * std::numbers::pi;
  const double dec_rad = std::asin(of_date.z());
  const double expected_ra_rad = (13.0 * 3600.0 + 13.0 * 60.0 + 30.749) * 15.0 * kArcsec_rad;
  const double expected_dec_rad = -(7.0 * 3600.0 + 47.0 * 60.0 + 1.74) * kArcsec_rad;
  EXPECT_NEAR(ra_rad, expected_ra_rad, 0.1 * kArcsec_rad);
  EXPECT_NEAR(dec_rad, expected_dec_rad, 0.1 * kArcsec_rad);
}

TEST(ApparentSun, MakesTheSunAngleOfAnIndependentSimulator) {
  // spin/nominal: the position at 03:00 is from its orbit.oem, axis and sun angle from its
  // truth.json. First-order aberration neglects (v/c)^2 = 1e-8 rad.
  const OrbitState spacecraft{{9918.094675523, -7288.360032301, -6492.901023684},
                              Eigen::Vector3d::Zero()};
  const double ra_rad = 100.0 * kRadPerDeg;
  const double dec_rad = -55.0 * kRadPerDeg;
  const Eigen::Vector3d axis{std::cos(dec_rad) * std::cos(ra_rad),
                             std::cos(dec_rad) * std::sin(ra_rad), std::sin(dec_rad)};
  const TaiTime t = parse_utc("2026-11-20T03:00:00").value();
  EXPECT_NEAR(angle_rad(axis, ApparentSun{}.direction_icrf(t, spacecraft)),
              96.23210033709218 * kRadPerDeg, 1e-8);
}

TEST(ApparentSun, IsThePlaceOfOneLightTimeAgo) {
  // Planetary aberration: to first order, light time and aberration together give the geometric
  // place relative to the Earth one light time ago. This neglects (v/c)^2 = 1e-8 rad and half the
  // square of the Earth's motion in that time, 5e-9 rad. The effect itself is 1e-4 rad.
  std::mt19937_64 rng{1725};
  ApparentSun sun;
  for (int trial = 0; trial < 300; ++trial) {
    const TaiTime t = random_time(rng);
    const double light_time_s = geometric_sun_icrf_km(t).norm() / kLight_km_s;
    const Eigen::Vector3d expected = geometric_sun_icrf_km(shifted(t, -light_time_s));
    const Eigen::Vector3d direction = sun.direction_icrf(t, kEarthCentre);
    SCOPED_TRACE(format_utc(t));
    ASSERT_NEAR(direction.norm(), 1.0, 1e-15);
    ASSERT_LT(angle_rad(direction, expected), 1.5e-8);
    ASSERT_GT(angle_rad(direction, geometric_sun_icrf_km(t)), 9e-5);
  }
}

TEST(ApparentSun, ParallaxIsThatOfTheSpacecraft) {
  // 42 164 km seen over 1 au are 2.8e-4 rad. Aberration rotates both directions alike, up to 1e-4
  // of it.
  std::mt19937_64 rng{42};
  ApparentSun sun;
  for (int trial = 0; trial < 100; ++trial) {
    const TaiTime t = random_time(rng);
    const Eigen::Vector3d to_sun_km = geometric_sun_icrf_km(t);
    const Eigen::Vector3d across = to_sun_km.unitOrthogonal();
    const OrbitState spacecraft{42'164.0 * across, Eigen::Vector3d::Zero()};
    const Eigen::Vector3d seen = sun.direction_icrf(t, spacecraft);
    const double parallax_rad = angle_rad(seen, sun.direction_icrf(t, kEarthCentre));
    ASSERT_NEAR(parallax_rad, std::atan(42'164.0 / to_sun_km.norm()), 4e-8);
    ASSERT_LT(seen.dot(across), sun.direction_icrf(t, kEarthCentre).dot(across));
  }
}

TEST(ApparentSun, InterpolationAgreesWithDirectEvaluation) {
  // The header promises 1 m in the Earth's position, 7e-12 rad. The reference computes the light
  // path with eraEpv00 at every time; velocities linear over an hour are accurate to 7e-12 c.
  std::mt19937_64 rng{3600};
  ApparentSun sun;
  for (int trial = 0; trial < 300; ++trial) {
    const TaiTime t = random_time(rng);
    const EarthMotion earth = earth_motion(t);
    const Eigen::Vector3d sun_km_s = earth.barycentric_icrf_km_s - earth.heliocentric_icrf_km_s;
    const Eigen::Vector3d now_km = -earth.heliocentric_icrf_km;
    const Eigen::Vector3d natural_km = now_km - now_km.norm() / kLight_km_s * sun_km_s;
    Eigen::Vector3d natural = natural_km.normalized();
    Eigen::Vector3d velocity_c = earth.barycentric_icrf_km_s / kLight_km_s;
    Eigen::Vector3d proper;
    eraAb(natural.data(), velocity_c.data(), natural_km.norm() / kAu_km,
          std::sqrt(1.0 - velocity_c.squaredNorm()), proper.data());
    ASSERT_LT(angle_rad(sun.direction_icrf(t, kEarthCentre), proper), 1.4e-11) << format_utc(t);
  }
}

TEST(ApparentSun, DoesNotDependOnWhatWasAskedBefore) {
  std::mt19937_64 rng{5};
  std::uniform_int_distribution<std::int64_t> within_ns{0, 4LL * 3'600'000'000'000};
  const TaiTime start = parse_utc("2016-12-31T22:30:00").value();
  std::vector<TaiTime> times;
  std::vector<Eigen::Vector3d> in_order;
  ApparentSun forward;
  for (int i = 0; i < 500; ++i) {
    times.push_back(start + std::chrono::nanoseconds{within_ns(rng)});
  }
  std::ranges::sort(times);
  for (const TaiTime t : times) {
    in_order.push_back(forward.direction_icrf(t, kEarthCentre));
  }
  ApparentSun shuffled;
  std::uniform_int_distribution<std::size_t> any{0, times.size() - 1};
  for (int i = 0; i < 1000; ++i) {
    const std::size_t pick = any(rng);
    ASSERT_EQ(shuffled.direction_icrf(times[pick], kEarthCentre), in_order[pick]);
    ASSERT_EQ(ApparentSun{}.direction_icrf(times[pick], kEarthCentre), in_order[pick]);
  }
}

TEST(ApparentSun, IsContinuousAcrossTheHour) {
  ApparentSun sun;
  const TaiTime hour = parse_tai("2026-11-20T04:00:00").value();
  const Eigen::Vector3d before =
      sun.direction_icrf(hour - std::chrono::nanoseconds{1}, kEarthCentre);
  const Eigen::Vector3d after = sun.direction_icrf(hour, kEarthCentre);
  EXPECT_LT((after - before).norm(), 1e-15);
}

}  // namespace spindrift::sun_test
