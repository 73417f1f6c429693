#include "pipelines/ephemeris/oem_holes.h"

#include <utility>
#include <vector>

#include "pipelines/ephemeris/kepler_orbit.h"
#include "pipelines/ephemeris/oem_writer.h"
#include "tests/support/matchers.h"
#include "tests/support/outcome.h"
#include "tests/support/test_paths.h"
#include "tests/support/text_of.h"

namespace spindrift::oem_holes_test {

using namespace std::chrono_literals;

constexpr TaiTime kPerigee = tai_from_ns(1'795'143'637'000'000'000);

/// Has its perigee of 200 km altitude at kPerigee.
const KeplerOrbit kTransfer = KeplerOrbit::make({.epoch = kPerigee,
                                                 .semi_major_axis_km = 24'400.0,
                                                 .eccentricity = 0.7304,
                                                 .inclination_rad = 0.5,
                                                 .raan_rad = 1.0,
                                                 .argument_of_perigee_rad = 3.0,
                                                 .mean_anomaly_rad = 0.0})
                                  .value();

/// Returns states of the transfer orbit at these times from its perigee, s, in lines from 14 on.
OemSegment states_at(const std::vector<double>& times_s,
                     Interpolation interpolation = Interpolation::Hermite, int degree = 7) {
  std::vector<EphemerisPoint> points;
  for (const double time_s : times_s) {
    const TaiTime t = shifted(kPerigee, time_s);
    points.push_back(
        {.t = t, .state = kTransfer.at(t).value(), .line = 14 + static_cast<int>(points.size())});
  }
  const TaiTime first = points.front().t;
  const TaiTime last = points.back().t;
  return {first, last, interpolation, degree, std::move(points)};
}

/// Returns times every `step_s`, without those in the hole.
std::vector<double> even_s(double from_s, double to_s, double step_s, double hole_from_s = 0.0,
                           double hole_to_s = 0.0) {
  std::vector<double> times_s;
  for (double time_s = from_s; time_s <= to_s; time_s += step_s) {
    if (time_s <= hole_from_s || time_s >= hole_to_s) {
      times_s.push_back(time_s);
    }
  }
  return times_s;
}

Expected<OrbitEphemeris> cut(OemSegment segment) {
  std::vector<OemSegment> segments;
  segments.push_back(std::move(segment));
  return OrbitEphemeris::make(std::move(segments)).and_then(cut_at_holes);
}

TEST(OemHoles, HalfAnHourOfAPerigeeIsCutOut) {
  const OrbitEphemeris orbit = cut(states_at(even_s(-7200.0, 7200.0, 60.0, -900.0, 900.0))).value();
  const auto gaps = orbit_gaps(orbit);
  ASSERT_EQ(gaps.size(), 1U);
  EXPECT_EQ(gaps[0].from, kPerigee - 900s);
  EXPECT_EQ(gaps[0].to, kPerigee + 900s);
  EXPECT_EQ(gaps[0].line, 14 + 106);
  EXPECT_EQ(orbit.at(kPerigee).error().code, ErrorCode::NoCoverage);
  for (const double time_s : even_s(-7200.0, 7200.0, 13.0, -900.0, 900.0)) {
    const TaiTime t = shifted(kPerigee, time_s);
    ASSERT_LT(
        (orbit.at(t).value().position_icrf_km - kTransfer.at(t).value().position_icrf_km).norm(),
        1e-3)
        << time_s;
  }
}

TEST(OemHoles, StepsThatTheInterpolationBridgesStayWhole) {
  // The steps are denser near perigee, as propagators write them.
  std::vector<double> adapted_s = even_s(-7200.0, -1200.0, 300.0);
  for (const double dense_s : even_s(-1170.0, 1170.0, 30.0)) {
    adapted_s.push_back(dense_s);
  }
  for (const double sparse_s : even_s(1200.0, 7200.0, 300.0)) {
    adapted_s.push_back(sparse_s);
  }
  // Ten lines are missing far from perigee, or one anywhere.
  for (const std::vector<double>& times_s :
       {adapted_s, even_s(7200.0, 14'400.0, 60.0, 9000.0, 9600.0),
        even_s(-7200.0, 7200.0, 60.0, -60.0, 60.0)}) {
    EXPECT_EQ(cut(states_at(times_s))->segments().size(), 1U);
  }
}

TEST(OemHoles, EvenlySparseStatesAreTakenAtTheirWord) {
  const OrbitEphemeris orbit = cut(states_at(even_s(-7200.0, 7200.0, 1800.0))).value();
  EXPECT_EQ(orbit.segments().size(), 1U);
  EXPECT_TRUE(orbit_gaps(orbit).empty());
}

TEST(OemHoles, PartsTooShortForTheInterpolationAreLeftOut) {
  // Three points follow the hole, whereas Lagrange of degree 5 needs six.
  const auto times_s = even_s(-3000.0, 1020.0, 60.0, -900.0, 900.0);
  const OrbitEphemeris orbit = cut(states_at(times_s, Interpolation::Lagrange, 5)).value();
  EXPECT_EQ(orbit.segments().size(), 1U);
  EXPECT_EQ(orbit.usable_to(), kPerigee - 900s);
}

TEST(OemHoles, AnOrbitOfNothingElseIsRefusedByLine) {
  EXPECT_THAT(
      cut(states_at({-960.0, -930.0, -900.0, 900.0, 930.0, 960.0}, Interpolation::Lagrange, 5)),
      IsRefused(ErrorCode::InvalidConfiguration,
                HasSubstr("line 17: too long after the data line before it")));
}

TEST(OemHoles, ASegmentEndsWhereItsUsableTimesEndToo) {
  OemSegment segment = states_at(even_s(-7200.0, 7200.0, 60.0, -900.0, 900.0));
  segment.usable_from = kPerigee - 3600s;
  segment.usable_to = kPerigee + 3600s;
  const OrbitEphemeris orbit = cut(segment).value();
  EXPECT_EQ(orbit.usable_from(), kPerigee - 3600s);
  EXPECT_EQ(orbit.usable_to(), kPerigee + 3600s);
  EXPECT_EQ(orbit_gaps(orbit).size(), 1U);
  // The hole is outside the usable interval.
  segment.usable_from = kPerigee + 3600s;
  segment.usable_to = kPerigee + 7200s;
  EXPECT_TRUE(orbit_gaps(cut(segment).value()).empty());
}

TEST(OemHoles, AGapBetweenSegmentsIsOne) {
  std::vector<OemSegment> segments = {states_at(even_s(-3600.0, 0.0, 60.0)),
                                      states_at(even_s(1.0, 3601.0, 60.0))};
  const OrbitEphemeris orbit = OrbitEphemeris::make(std::move(segments)).value();
  const auto gaps = orbit_gaps(orbit);
  ASSERT_EQ(gaps.size(), 1U);
  EXPECT_EQ(gaps[0].to - gaps[0].from, 1s);
}

TEST(OemHoles, AreCutOutOfTheMessageThatIsRead) {
  const OemSegment segment = states_at(even_s(-7200.0, 7200.0, 60.0, -900.0, 900.0));
  const auto read = value_or_throw(parse_oem(oem_text("TEST", kPerigee, segment.points)));
  const auto gaps = orbit_gaps(read);
  ASSERT_EQ(gaps.size(), 1U);
  EXPECT_EQ(gaps[0].from, kPerigee - 900s);
  EXPECT_EQ(read.at(kPerigee).error().code, ErrorCode::NoCoverage);
}

TEST(OemHoles, OfRecordedOrbitsThereAreNone) {
  for (const char* const name :
       {"spin/nominal/orbit.oem", "spin/dirty/orbit.oem", "spin/coded/orbit.oem",
        "spin/north-only/orbit.oem", "spin/gms5/orbit.oem", "mission/orbit.oem"}) {
    SCOPED_TRACE(name);
    EXPECT_TRUE(orbit_gaps(value_or_throw(parse_oem(text_of(test_data() / name)))).empty());
  }
}

}  // namespace spindrift::oem_holes_test
