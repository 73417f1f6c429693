#include "pipelines/ephemeris/orbit_steps.h"

#include "pipelines/ephemeris/kepler_orbit.h"
#include "tests/support/matchers.h"
#include "tests/support/stepped_orbit.h"

namespace spindrift::orbit_steps_test {

constexpr TaiTime kStart = tai_from_ns(1'795'143'637'000'000'000);
const Eigen::Vector3d kNone = Eigen::Vector3d::Zero();

/// Returns half an hour of a low orbit with a point every minute.
OemSegment half_an_hour() {
  const auto orbit = KeplerOrbit::make({.epoch = kStart,
                                        .semi_major_axis_km = 7000.0,
                                        .eccentricity = 0.001,
                                        .inclination_rad = 1.7,
                                        .raan_rad = 0.3,
                                        .argument_of_perigee_rad = 0.2,
                                        .mean_anomaly_rad = 0.1})
                         .value();
  OemSegment segment{.usable_from = kStart,
                     .usable_to = shifted(kStart, 1800.0),
                     .interpolation = Interpolation::Hermite,
                     .degree = 7,
                     .points = {}};
  for (int i = 0; i <= 30; ++i) {
    const TaiTime t = shifted(kStart, 60.0 * i);
    segment.points.push_back({.t = t, .state = orbit.at(t).value(), .line = 17 + i});
  }
  return segment;
}

OrbitEphemeris stepped(const Eigen::Vector3d& by_km, const Eigen::Vector3d& by_km_s) {
  return testing::stepped(half_an_hour(), shifted(kStart, 600.0), by_km, by_km_s);
}

TEST(OrbitSteps, AreThoseOfSegmentsThatDoNotMeet) {
  const auto of_velocity = orbit_steps(stepped(kNone, {0.0, 0.12, 0.0}));
  ASSERT_THAT(of_velocity, SizeIs(1));
  EXPECT_EQ(of_velocity[0].from, shifted(kStart, 600.0));
  EXPECT_EQ(of_velocity[0].to, shifted(kStart, 600.0));
  EXPECT_EQ(of_velocity[0].line, 27);
  EXPECT_NEAR(of_velocity[0].off_km, 0.0, 1e-9);
  EXPECT_NEAR(of_velocity[0].off_km_s, 0.12, 1e-9);
  const auto of_position = orbit_steps(stepped({0.0, 0.0, 5.0}, kNone));
  ASSERT_THAT(of_position, SizeIs(1));
  EXPECT_NEAR(of_position[0].off_km, 5.0, 1e-9);
  EXPECT_NEAR(of_position[0].off_km_s, 0.0, 1e-9);
}

TEST(OrbitSteps, AreNoneWhereSegmentsGoOnOrAreRounded) {
  EXPECT_THAT(orbit_steps(stepped(kNone, kNone)), IsEmpty());
  // The limits are 1 km and 1 m/s.
  EXPECT_THAT(orbit_steps(stepped({0.9, 0.0, 0.0}, {0.0, 9e-4, 0.0})), IsEmpty());
  EXPECT_THAT(orbit_steps(OrbitEphemeris::make({half_an_hour()}).value()), IsEmpty());
}

/// Each segment also has the other's states outside its usable interval; the joint is between two
/// states.
TEST(OrbitSteps, AreThoseAtTheInstantWhereOneSegmentTakesOverFromTheOther) {
  for (const double by_km_s : {0.0, 0.005}) {
    OemSegment before = half_an_hour();
    OemSegment behind = half_an_hour();
    before.usable_to = behind.usable_from = shifted(kStart, 630.0);
    for (EphemerisPoint& point : behind.points) {
      point.state.position_icrf_km.x() += seconds_between(before.usable_to, point.t) * by_km_s;
      point.state.velocity_icrf_km_s.x() += by_km_s;
    }
    const auto steps = orbit_steps(OrbitEphemeris::make({before, behind}).value());
    ASSERT_THAT(steps, SizeIs(by_km_s == 0.0 ? 0 : 1));
    if (!steps.empty()) {
      EXPECT_EQ(steps[0].to, shifted(kStart, 630.0));
      EXPECT_NEAR(steps[0].off_km, 0.0, 1e-3);
      EXPECT_NEAR(steps[0].off_km_s, by_km_s, 1e-6);
    }
  }
}

TEST(OrbitSteps, AreFoundAcrossAGap) {
  for (const double by_km_s : {0.0, 0.12}) {
    auto segments = stepped(kNone, {0.0, by_km_s, 0.0}).segments();
    segments[1].points.erase(segments[1].points.begin(), segments[1].points.begin() + 3);
    segments[1].usable_from = segments[1].points.front().t;
    const auto steps = orbit_steps(OrbitEphemeris::make(segments).value());
    ASSERT_THAT(steps, SizeIs(by_km_s == 0.0 ? 0 : 1));
    if (!steps.empty()) {
      EXPECT_EQ(steps[0].from, shifted(kStart, 600.0));
      EXPECT_EQ(steps[0].to, shifted(kStart, 780.0));
    }
  }
}

TEST(OrbitSteps, AreTheJumpsOfASegmentToo) {
  OemSegment jumps = half_an_hour();
  for (std::size_t i = 12; i < jumps.points.size(); ++i) {
    jumps.points[i].state.position_icrf_km.x() += 18.0;
  }
  const auto steps = orbit_steps(OrbitEphemeris::make({jumps}).value());
  ASSERT_THAT(steps, SizeIs(1));
  EXPECT_EQ(steps[0].from, shifted(kStart, 660.0));
  EXPECT_EQ(steps[0].to, shifted(kStart, 720.0));
  EXPECT_NEAR(steps[0].off_km, 18.0, 0.1);
}

TEST(OrbitSteps, LieWithinWhatIsUsedOnBothSides) {
  const auto steps = orbit_steps(stepped(kNone, {0.0, 0.12, 0.0}));
  const auto at = [](double after_s) { return shifted(kStart, after_s); };
  EXPECT_TRUE(step_within(steps, at(0.0), at(601.0)));
  EXPECT_FALSE(step_within(steps, at(0.0), at(600.0)));
  EXPECT_FALSE(step_within(steps, at(600.0), at(1800.0)));
  EXPECT_TRUE(step_within(steps, at(599.0), at(1800.0)));
}

}  // namespace spindrift::orbit_steps_test
