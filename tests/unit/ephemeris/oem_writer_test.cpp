#include "pipelines/ephemeris/oem_writer.h"

#include "tests/support/matchers.h"
#include "tests/support/outcome.h"

namespace spindrift::oem_writer_test {

using namespace std::chrono_literals;

constexpr TaiTime kStart = tai_from_ns(1795143637123456789);

Orbit orbit_of(double a_km, double e) {
  return Orbit{KeplerOrbit::make({.epoch = kStart + 1h,
                                  .semi_major_axis_km = a_km,
                                  .eccentricity = e,
                                  .inclination_rad = 0.5,
                                  .raan_rad = 1.0,
                                  .argument_of_perigee_rad = 2.0,
                                  .mean_anomaly_rad = 0.0})
                   .value()};
}

TEST(OemWriter, GivesTheOrbitBackWithinAMillimetre) {
  // A low orbit, and a transfer and a lunar transfer orbit through their perigees at 200 km.
  for (const auto& [a_km, e] :
       {std::pair{6578.0, 0.0}, std::pair{24400.0, 0.7304}, std::pair{200000.0, 0.9671}}) {
    SCOPED_TRACE(a_km);
    const Orbit orbit = orbit_of(a_km, e);
    const auto points = sampled_orbit(orbit, kStart, kStart + 2h, 60s).value();
    const auto read = value_or_throw(parse_oem(oem_text("TEST 1", kStart, points)));
    EXPECT_EQ(read.usable_from(), kStart);
    EXPECT_EQ(read.usable_to(), kStart + 2h);
    for (TaiTime t = kStart; t <= kStart + 2h; t += 7s) {
      const OrbitState expected = orbit.at(t).value();
      const OrbitState state = read.at(t).value();
      ASSERT_LT((state.position_icrf_km - expected.position_icrf_km).norm(), 1e-6);
      ASSERT_LT((state.velocity_icrf_km_s - expected.velocity_icrf_km_s).norm(), 1e-6);
    }
  }
}

TEST(OemWriter, WritesThroughALeapSecond) {
  const TaiTime before = tai_from_ns(1483228800000000000);  // 2016-12-31T23:59:24 UTC.
  const Orbit orbit = orbit_of(42164.0, 0.0);
  const auto points = sampled_orbit(orbit, before, before + 5min, 12s).value();
  const std::string text = oem_text("TEST", before, points);
  EXPECT_THAT(text, HasSubstr("\n2016-12-31T23:59:60.000000000 "));
  const auto read = value_or_throw(parse_oem(text));
  EXPECT_EQ(read.usable_to(), points.back().t);
}

TEST(OemWriter, ReachesTheEndAskedFor) {
  const auto points = sampled_orbit(orbit_of(7000.0, 0.0), kStart, kStart + 61s, 60s).value();
  ASSERT_EQ(points.size(), 3U);
  EXPECT_EQ(points.back().t, kStart + 61s);
}

TEST(OemWriter, SaysWhereTheOrbitEnds) {
  const auto points = sampled_orbit(orbit_of(7000.0, 0.0), kStart, kStart + 1h, 60s).value();
  const Orbit ephemeris{parse_oem(oem_text("TEST", kStart, points)).value()};
  EXPECT_THAT(sampled_orbit(ephemeris, kStart, kStart + 2h, 60s),
              IsRefused(ErrorCode::NoCoverage, _));
}

}  // namespace spindrift::oem_writer_test
