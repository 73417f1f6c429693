#include "pipelines/reconstruction/request.h"

#include "pipelines/reconstruction/event_times.h"
#include "tests/support/matchers.h"
#include "tests/support/outcome.h"
#include "tests/support/separation_flight.h"

namespace spindrift::testing::request_test {

OrbitState circular(double radius_km) {
  return {.position_icrf_km = {radius_km, 0.0, 0.0}, .velocity_icrf_km_s = {0.0, 7.5, 0.0}};
}

TEST(ReconstructionRequestTest, AnOrbitIsThatOfTheFirstStateFromT1OnThatIsOnOne) {
  ReconstructionRequest request = separation_flight({}, 1).request();
  request.orbit.reset();
  const TaiTime t1 = request.times.separation;
  EXPECT_FALSE(orbit_of(request));
  request.orbit_states = {{shifted(t1, 90.0), circular(7300.0)},
                          {shifted(t1, -1.0), circular(7100.0)},
                          {shifted(t1, 20.0), circular(100.0)},  // Inside the Earth.
                          {shifted(t1, 60.0), circular(7200.0)}};
  const auto orbit = orbit_of(request).value();
  EXPECT_NEAR(orbit.at(shifted(t1, 60.0)).value().position_icrf_km.x(), 7200.0, 1e-6);
}

TEST(ReconstructionRequestTest, ASunSeenBehindAllStarFixesShowsNoT3) {
  const SeparationFlight flight = separation_flight({}, 1);
  const SunDirection late{shifted(flight.stars.back().t, 1.0), Eigen::Vector3d::UnitX()};
  const SeparationTimes times{.separation = flight.times.separation};
  const auto events = value_or_throw(
      event_times(times, {.gyro = flight.gyro, .sun = {&late, 1}, .stars = flight.stars}));
  ASSERT_EQ(events.size(), 3U);
  EXPECT_EQ(events.back().event, SeparationEvent::FirstStarFix);
  EXPECT_EQ(events.back().t, flight.stars.front().t);
}

}  // namespace spindrift::testing::request_test
