#include <numbers>
#include <random>

#include "pipelines/spin/measurement/measurement.h"
#include "pipelines/spin/planning/pass_geometry.h"
#include "tests/support/matchers.h"
#include "tests/support/observed_spin.h"

namespace spindrift::testing::expected_revolution_test {

using enum PulseChannel;

struct Scene : Surroundings {
  ExpectedRevolution expected(const SpinningBody& body, TaiTime t, bool sun_hidden = false) const {
    return expected_revolution(body.config, sky_at(orbit, t), spin_frame(body.axis_icrf),
                               body.rate_rad_s, sun_hidden);
  }
};

TEST(ExpectedRevolution, HasTheOraclesEdges) {
  const Scene scene;
  std::mt19937_64 rng{3};
  // The beams are a seventh of a turn apart, so that one of them crosses sun1 repeatedly.
  for (int trial = 0; trial < 40; ++trial) {
    SCOPED_TRACE(trial);
    auto body = random_body(scene.around, 0.05, rng);
    body.rate_rad_s /= trial % 2 == 0 ? 1.0 : 10.0;
    body.config.north->azimuth_rad = 0.157 * trial;
    const Revolution seen = revolution_seen(body, scene.around, kTransferStart);
    const ExpectedRevolution expected = scene.expected(body, *seen.edge(Sun1));
    for (std::size_t i = 0; i < kPulseChannels; ++i) {
      SCOPED_TRACE(i);
      ASSERT_TRUE(seen.edges.at(i) && expected.revolution.edges.at(i));
      // The Sun moves 2e-7 rad a second, up to 2e-6 rad in a slow turn.
      EXPECT_NEAR(seconds_between(*seen.edges.at(i), *expected.revolution.edges.at(i)), 0.0, 3e-6);
      EXPECT_FALSE(expected.revolution.edge_rejections.at(i));
    }
  }
}

TEST(ExpectedRevolution, HasNoSunEdgesBehindTheEarth) {
  const Scene scene;
  std::mt19937_64 rng{3};
  const auto body = random_body(scene.around, 0.05, rng);
  const ExpectedRevolution hidden = scene.expected(body, kTransferStart, true);
  const ExpectedRevolution lit = scene.expected(body, kTransferStart);
  for (const PulseChannel channel : {Sun1, Sun2}) {
    EXPECT_FALSE(hidden.revolution.edge(channel));
    EXPECT_TRUE(lit.revolution.edge(channel));
  }
  for (const PulseChannel channel : {NorthIn, NorthOut, SouthIn, SouthOut}) {
    EXPECT_EQ(hidden.revolution.edge(channel), lit.revolution.edge(channel));
  }
}

TEST(ExpectedRevolution, LeavesOutEdgesThatMeet) {
  const Scene scene;
  std::mt19937_64 rng{3};
  auto body = random_body(scene.around, 0.05, rng);
  // The chords differ, so that only their beginnings can coincide.
  body.config.south->mount_angle_rad = 100.0 * std::numbers::pi / 180.0;
  const ExpectedRevolution apart = scene.expected(body, kTransferStart);
  EXPECT_TRUE(apart.meeting.empty());
  // South's beginning is placed 3 ms before north's, more than 2.5 sigma of both (1.8 ms).
  const double gap_s =
      seconds_between(*apart.revolution.edge(NorthIn), *apart.revolution.edge(SouthIn));
  body.config.south->azimuth_rad -= (gap_s + 3e-3) * body.rate_rad_s;
  body.config.screening.interference_s = 1e-3;
  EXPECT_TRUE(scene.expected(body, kTransferStart).meeting.empty());
  body.config.screening.interference_s = 2e-3;
  const ExpectedRevolution met = scene.expected(body, kTransferStart);
  ASSERT_EQ(met.meeting.size(), 1U);
  EXPECT_EQ(met.meeting.front().one, NorthIn);
  EXPECT_EQ(met.meeting.front().other, SouthIn);
  EXPECT_FALSE(met.revolution.good_edge(NorthIn));
  EXPECT_FALSE(met.revolution.good_edge(SouthIn));
  EXPECT_TRUE(met.revolution.good_edge(NorthOut));
  EXPECT_TRUE(met.revolution.good_edge(Sun1));
}

}  // namespace spindrift::testing::expected_revolution_test
