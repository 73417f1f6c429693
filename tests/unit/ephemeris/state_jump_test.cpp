#include "pipelines/ephemeris/state_jump.h"

#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include "pipelines/ephemeris/kepler_orbit.h"
#include "tests/support/matchers.h"

namespace spindrift::state_jump_test {

constexpr TaiTime kStart = tai_from_ns(1'795'143'637'000'000'000);
constexpr double kMu_km3_s2 = 398'600.4418;
constexpr double kEarthRadius_km = 6'378.137;
constexpr double kJ2 = 1.08263e-3;

constexpr std::array kSteps_s = {30.0, 60.0, 120.0, 240.0};
constexpr std::array kSparseSteps_s = {60.0, 300.0, 600.0, 1800.0, 3600.0, 21'600.0};

struct Shape {
  const char* name;
  double perigee_km;  ///< Distance of the perigee from the Earth's centre.
  double eccentricity;
};
constexpr std::array kShapes = {
    Shape{"low", 6'578.0, 0.001},          Shape{"low, 1200 km", 7'578.0, 0.02},
    Shape{"transfer", 6'578.0, 0.73},      Shape{"Molniya", 6'978.0, 0.74},
    Shape{"geostationary", 42'164.0, 0.0}, Shape{"moon-bound", 6'578.0, 0.967}};

Eigen::Vector3d random_direction(std::mt19937& rng) {
  std::normal_distribution<double> any;
  const double x = any(rng);
  const double y = any(rng);
  return Eigen::Vector3d{x, y, any(rng)}.normalized();
}

/// Returns a state on an orbit of this shape with random orientation and anomaly.
OrbitState random_state(std::mt19937& rng, const Shape& shape) {
  std::uniform_real_distribution<double> any_rad{0.0, 2.0 * std::numbers::pi};
  return KeplerOrbit::make({.epoch = kStart,
                            .semi_major_axis_km = shape.perigee_km / (1.0 - shape.eccentricity),
                            .eccentricity = shape.eccentricity,
                            .inclination_rad = 0.5 * any_rad(rng),
                            .raan_rad = any_rad(rng),
                            .argument_of_perigee_rad = any_rad(rng),
                            .mean_anomaly_rad = any_rad(rng)})
      .value()
      .at(kStart)
      .value();
}

/// Source: Vallado, Fundamentals of Astrodynamics and Applications, on the perturbation by J2.
Eigen::Vector3d acceleration_km_s2(const Eigen::Vector3d& r_km, double j2_of_earth) {
  const double range_km = r_km.norm();
  const double sin2_latitude = std::pow(r_km.z() / range_km, 2);
  const double j2 = 1.5 * j2_of_earth * std::pow(kEarthRadius_km / range_km, 2);
  return -kMu_km3_s2 / std::pow(range_km, 3) *
         Eigen::Vector3d{r_km.x() * (1.0 + j2 * (1.0 - 5.0 * sin2_latitude)),
                         r_km.y() * (1.0 + j2 * (1.0 - 5.0 * sin2_latitude)),
                         r_km.z() * (1.0 + j2 * (3.0 - 5.0 * sin2_latitude))};
}

/// Propagates by leapfrog in steps of a second, accurate to some metres.
OrbitState flown(OrbitState state, double duration_s, double j2_of_earth = kJ2) {
  const int steps = static_cast<int>(std::ceil(duration_s));
  const double dt_s = duration_s / std::max(1, steps);
  for (int i = 0; i < steps; ++i) {
    state.position_icrf_km += 0.5 * dt_s * state.velocity_icrf_km_s;
    state.velocity_icrf_km_s += dt_s * acceleration_km_s2(state.position_icrf_km, j2_of_earth);
    state.position_icrf_km += 0.5 * dt_s * state.velocity_icrf_km_s;
  }
  return state;
}

EphemerisPoint point(double after_s, const OrbitState& state) {
  return {.t = shifted(kStart, after_s), .state = state};
}

/// Expects none of a hundred steps on orbits of every shape to be unexplained.
template <class Steps, class Next>
void expect_explained(const Steps& steps_s, Next next) {
  for (const double step_s : steps_s) {
    std::mt19937 rng{7};
    for (const Shape& shape : kShapes) {
      SCOPED_TRACE(::testing::Message() << shape.name << ", " << step_s << " s");
      for (int trial = 0; trial < 100; ++trial) {
        const OrbitState from = random_state(rng, shape);
        const OrbitState to = next(from, step_s, rng);
        EXPECT_FALSE(unexplained_km(point(0.0, from), point(step_s, to))) << trial;
      }
    }
  }
}

TEST(UnexplainedStep, IsOneOf18KmToAnySide) {
  std::mt19937 rng{1};
  for (const Shape& shape : kShapes) {
    for (const double step_s : kSteps_s) {
      SCOPED_TRACE(::testing::Message() << shape.name << ", " << step_s << " s");
      for (int trial = 0; trial < 100; ++trial) {
        const OrbitState from = random_state(rng, shape);
        OrbitState to = flown(from, step_s);
        to.position_icrf_km += 18.0 * random_direction(rng);
        const auto off_km = unexplained_km(point(0.0, from), point(step_s, to)).value();
        // J2 accounts for half of 3.2e-5 km/s^2 times (240 s)^2, which is 0.92 km.
        EXPECT_NEAR(off_km, 18.0, 1.0);
      }
    }
  }
}

TEST(UnexplainedStep, IsOneOntoTheSameOrbit18KmAhead) {
  std::mt19937 rng{2};
  for (const Shape& shape : kShapes) {
    for (const double step_s : kSteps_s) {
      SCOPED_TRACE(::testing::Message() << shape.name << ", " << step_s << " s");
      for (int trial = 0; trial < 20; ++trial) {
        const OrbitState from = random_state(rng, shape);
        const double ahead_s = 18.0 / from.velocity_icrf_km_s.norm();
        const OrbitState to = flown(from, step_s + ahead_s);
        EXPECT_TRUE(unexplained_km(point(0.0, from), point(step_s, to)));
      }
    }
  }
}

TEST(UnexplainedStep, IsNoneOfTwoBodiesNorRoundAnEarthWithJ2) {
  for (const double j2 : {0.0, kJ2}) {
    SCOPED_TRACE(j2);
    expect_explained(kSparseSteps_s, [&](const OrbitState& from, double step_s, std::mt19937&) {
      return flown(from, step_s, j2);
    });
  }
}

TEST(UnexplainedStep, IsNoneWithAManoeuvreOf10MetresASecondAtAnyTimeOfIt) {
  expect_explained(std::array{60.0, 240.0, 600.0, 1200.0, 1800.0},
                   [](const OrbitState& from, double step_s, std::mt19937& rng) {
                     const double burn_s = std::uniform_real_distribution<double>{0.0, step_s}(rng);
                     OrbitState state = flown(from, burn_s);
                     state.velocity_icrf_km_s += 0.01 * random_direction(rng);
                     return flown(state, step_s - burn_s);
                   });
}

TEST(Departure, IsNoneRoundAnEarthWithJ2) {
  for (const double step_s : kSparseSteps_s) {
    std::mt19937 rng{8};
    for (const Shape& shape : kShapes) {
      for (int trial = 0; trial < 50; ++trial) {
        const OrbitState from = random_state(rng, shape);
        EXPECT_FALSE(departure(point(0.0, from), point(step_s, flown(from, step_s))))
            << shape.name << ", " << step_s << " s";
      }
    }
  }
}

TEST(Departure, IsAManoeuvreOrAStepOfAnySort) {
  std::mt19937 rng{9};
  for (const Shape& shape : kShapes) {
    const OrbitState from = random_state(rng, shape);
    OrbitState to = from;
    to.velocity_icrf_km_s += 0.002 * random_direction(rng);
    EXPECT_NEAR(departure(point(0.0, from), point(0.0, to)).value().km_s, 0.002, 1e-12);
    to = from;
    to.position_icrf_km += 1.1 * random_direction(rng);
    EXPECT_NEAR(departure(point(0.0, from), point(0.0, to)).value().km, 1.1, 1e-9);
    EXPECT_FALSE(departure(point(0.0, from), point(0.0, from)));
  }
}

/// Returns a segment with a point every minute, the first in `line`, of which the first and the
/// last `margin` points are not usable.
OemSegment segment_of(const std::vector<OrbitState>& states, int first_minute, int line,
                      int margin) {
  std::vector<EphemerisPoint> points;
  for (const OrbitState& state : states) {
    const int i = static_cast<int>(points.size());
    points.push_back(
        {.t = shifted(kStart, 60.0 * (first_minute + i)), .state = state, .line = line + i});
  }
  const auto outer = static_cast<std::size_t>(margin);
  const TaiTime usable_from = points[outer].t;
  const TaiTime usable_to = points[points.size() - 1 - outer].t;
  return {usable_from, usable_to, Interpolation::Hermite, 3, std::move(points)};
}

std::vector<OrbitState> minutes(const OrbitState& start, int from, int to) {
  std::vector<OrbitState> states;
  for (int minute = from; minute <= to; ++minute) {
    states.push_back(flown(start, 60.0 * minute));
  }
  return states;
}

OrbitState low_orbit() {
  std::mt19937 rng{3};
  return random_state(rng, kShapes.front());
}

std::vector<OrbitJump> jumps_of(std::vector<OemSegment> segments) {
  return orbit_jumps(OrbitEphemeris::make(std::move(segments)).value());
}

TEST(OrbitJumps, AreFoundWhereASegmentHasThem) {
  std::vector<OrbitState> states = minutes(low_orbit(), 0, 10);
  for (std::size_t i = 6; i < states.size(); ++i) {
    states[i].position_icrf_km.x() += 18.0;
  }
  const auto jumps = jumps_of({segment_of(states, 0, 17, 0)});
  ASSERT_EQ(jumps.size(), 1U);
  EXPECT_EQ(jumps[0].to.line, 23);
  EXPECT_EQ(jumps[0].to.t, shifted(kStart, 360.0));
  EXPECT_NEAR(jumps[0].off_km, 18.0, 0.1);
}

TEST(OrbitJumps, OfASingleWrongStateAreThoseToItAndFromIt) {
  std::vector<OrbitState> states = minutes(low_orbit(), 0, 10);
  states[5].position_icrf_km.z() -= 18.0;
  EXPECT_EQ(jumps_of({segment_of(states, 0, 17, 0)}).size(), 2U);
}

TEST(OrbitJumps, AreFoundBetweenSegmentsThatTouchOverlapOrLeaveAGap) {
  const OrbitState start = low_orbit();
  OrbitState other = start;
  other.position_icrf_km.y() += 18.0;
  const OemSegment first = segment_of(minutes(start, 0, 10), 0, 17, 0);
  const OemSegment outer_first = segment_of(minutes(start, 0, 12), 0, 17, 2);
  for (const OrbitState& second : {start, other}) {
    const std::size_t expected = second.position_icrf_km == start.position_icrf_km ? 0 : 1;
    EXPECT_EQ(jumps_of({first, segment_of(minutes(second, 10, 20), 10, 40, 0)}).size(), expected);
    EXPECT_EQ(jumps_of({first, segment_of(minutes(second, 11, 20), 11, 40, 0)}).size(), expected);
    const auto overlapping = jumps_of({outer_first, segment_of(minutes(second, 8, 20), 8, 40, 2)});
    ASSERT_EQ(overlapping.size(), expected);
    if (expected == 1) {
      EXPECT_EQ(overlapping[0].to.line, 42);
    }
  }
}

TEST(OrbitJumps, AreNotAManoeuvreBetweenSegmentsThatOverlapBeyondTheirUsableTimes) {
  const OrbitState before = low_orbit();
  OrbitState burnt = flown(before, 600.0);
  burnt.velocity_icrf_km_s += Eigen::Vector3d{0.1, 0.0, 0.0};
  // The later segment begins where the orbit after the burn would have come from, 12 km away.
  OrbitState reversed = burnt;
  reversed.velocity_icrf_km_s *= -1.0;
  reversed = flown(reversed, 120.0);
  reversed.velocity_icrf_km_s *= -1.0;
  const std::vector<OrbitState> after = minutes(reversed, 0, 12);
  EXPECT_TRUE(jumps_of({segment_of(minutes(before, 0, 12), 0, 17, 2), segment_of(after, 8, 40, 2)})
                  .empty());
}

}  // namespace spindrift::state_jump_test
