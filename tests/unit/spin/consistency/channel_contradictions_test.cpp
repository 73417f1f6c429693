#include "pipelines/spin/consistency/channel_contradictions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "pipelines/frames/angle.h"
#include "pipelines/time/time_span.h"
#include "tests/support/misaligned.h"
#include "tests/support/observed_spin.h"

namespace spindrift::channel_contradictions_test {

using namespace spindrift::testing;
using enum PulseChannel;

/// Returns how late an edge comes, in s.
using Lateness = std::function<double(const Pulse& edge)>;

/// Holds a body at 60 rpm in the transfer orbit.
struct Scene : Surroundings {
  std::mt19937_64 rng{47};
  SpinningBody body = random_body(around, 4.0 * kRadPerDeg, rng);

  Scene() {
    body.rate_rad_s = 2.0 * std::numbers::pi;
    body.config.alignment = usual_alignment();
  }

  std::vector<ObservedRevolution> seen(double to_s, const Lateness& late, const SpinConfig& file) {
    std::vector<Pulse> edges = pulses(body, 0.0, to_s, rng);
    for (Pulse& edge : edges) {
      edge.t = later_by_s(edge.t, late(edge));
    }
    std::sort(edges.begin(), edges.end());
    return observed(file, orbit, edges);
  }
};

/// Compares after every block and returns what is found in the end.
std::optional<SensorContradiction> found_in(const std::vector<ObservedRevolution>& seen,
                                            const SpinConfig& file, double orbit_late_s = 0.0) {
  BlockCollector collector;
  ChannelContradictions contradictions;
  for (const ObservedRevolution& one : seen) {
    if (const auto block = collector.add(file.noise, one.revolution)) {
      Sky sky = one.sky;
      sky.t = later_by_s(sky.t, orbit_late_s);
      contradictions.add({.block = *block, .sky = sky});
      contradictions.compare(file, {});
    }
  }
  return contradictions.found();
}

std::optional<SensorContradiction> found_with(double to_s, const Lateness& late) {
  Scene scene;
  return found_in(scene.seen(to_s, late, scene.body.config), scene.body.config);
}

Lateness late_by(PulseChannel channel, double late_s) {
  return [=](const Pulse& edge) { return edge.channel == channel ? late_s : 0.0; };
}

TEST(ChannelContradictions, FindNoneWhereAllIsAsStated) {
  EXPECT_FALSE(found_with(60.0, [](const Pulse&) { return 0.0; }));
}

TEST(ChannelContradictions, FindNoneInErrorsThatTheMissionFileStates) {
  for (const auto error :
       {SlitCantError, SlitSeparationError, NorthAzimuthError, SouthMountAngleError}) {
    Scene scene;
    const SpinConfig file = scene.body.config;
    scene.body.config = true_config(file, 0.05 * kRadPerDeg * SpinAlignmentVector::Unit(error));
    EXPECT_FALSE(found_in(scene.seen(
                              30.0, [](const Pulse&) { return 0.0; }, file),
                          file))
        << error;
  }
}

TEST(ChannelContradictions, NameTheEndOfAChordThatComesLateInTenSeconds) {
  for (const PulseChannel channel : {NorthIn, NorthOut, SouthIn, SouthOut}) {
    const auto found = found_with(12.0, late_by(channel, 0.03));
    ASSERT_TRUE(found) << name_of(channel);
    EXPECT_EQ(culprit_name_of(*found), name_of(channel));
    EXPECT_EQ(found->off.name, "angle_deg");
    EXPECT_NEAR(std::get<double>(found->off.value), 10.8, 1.5);
    EXPECT_GT(found->sigmas, 20.0);
    EXPECT_EQ(found->with.size(), 5U);
  }
}

TEST(ChannelContradictions, NameABeamByItsFirstChannelWhereBothEndsAreLate) {
  const auto found = found_with(12.0, [](const Pulse& edge) {
    return edge.channel == SouthIn || edge.channel == SouthOut ? 0.03 : 0.0;
  });
  ASSERT_TRUE(found);
  EXPECT_EQ(culprit_name_of(*found), "south_in");
  EXPECT_EQ(opponents_text(*found), "sun1, sun2, north_in, north_out");
}

TEST(ChannelContradictions, CallItUnknownWhereTooFewAreLeftToTell) {
  Scene scene;
  SpinConfig file = scene.body.config;
  file.south.reset();
  auto seen = scene.seen(40.0, late_by(NorthIn, 0.05), scene.body.config);
  for (ObservedRevolution& one : seen) {
    one.revolution.edges[index_of(SouthIn)].reset();
    one.revolution.edges[index_of(SouthOut)].reset();
  }
  const auto found = found_in(seen, file);
  ASSERT_TRUE(found);
  EXPECT_EQ(culprit_name_of(*found), "unknown");
  EXPECT_GE(found->with.size(), 2U);
}

/// The file's sky is three minutes old: the Earth is degrees behind.
TEST(ChannelContradictions, NameAnOrbitThatIsLate) {
  Scene scene;
  const auto seen = scene.seen(
      60.0, [](const Pulse&) { return 0.0; }, scene.body.config);
  const auto found = found_in(seen, scene.body.config, 180.0);
  ASSERT_TRUE(found);
  EXPECT_EQ(culprit_name_of(*found), "orbit");
  EXPECT_EQ(found->off.name, "offset_s");
  EXPECT_NEAR(std::get<double>(found->off.value), -180.0, 40.0);
}

TEST(ChannelContradictions, EndAMinuteAfterTheChannelIsRightAgain) {
  const auto until_20_s = [](const Pulse& edge) {
    const bool is_early = seconds_between(kTransferStart, edge.t) < 20.0;
    return edge.channel == NorthOut && is_early ? 0.03 : 0.0;
  };
  EXPECT_TRUE(found_with(40.0, until_20_s));
  EXPECT_FALSE(found_with(110.0, until_20_s));
}

}  // namespace spindrift::channel_contradictions_test
