#include "pipelines/spin/consistency/channel_contradictions.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
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

/// An edge of the channel comes late between two times.
Lateness late_between(PulseChannel channel, double late_s, double from_s, double to_s) {
  return [=](const Pulse& edge) {
    const double t_s = seconds_between(kTransferStart, edge.t);
    return edge.channel == channel && t_s >= from_s && t_s < to_s ? late_s : 0.0;
  };
}

TEST(ChannelContradictions, EndWhenTheChannelHasBeenRightForTwoBlocks) {
  EXPECT_TRUE(found_with(24.0, late_between(NorthOut, 0.03, 0.0, 20.0)));
  EXPECT_FALSE(found_with(40.0, late_between(NorthOut, 0.03, 0.0, 20.0)));
  EXPECT_FALSE(found_with(110.0, late_between(NorthOut, 0.03, 0.0, 20.0)));
}

/// After a minute the late slit alone would be taken for another axis.
TEST(ChannelContradictions, RememberTheMinuteBeforeTheyBegan) {
  const auto found = found_with(180.0, late_between(Sun2, 0.006, 60.0, 200.0));
  ASSERT_TRUE(found);
  EXPECT_EQ(culprit_name_of(*found), "sun2");
  EXPECT_LT(seconds_between(kTransferStart, found->since), 75.0);
}

TEST(ChannelContradictions, NameAChannelThatScattersAlone) {
  for (const PulseChannel channel : {Sun2, NorthOut}) {
    std::mt19937_64 rng{48};
    std::normal_distribution<double> noise_s{0.0, 0.05};
    const auto found = found_with(50.0, [&](const Pulse& edge) {
      const bool is_late = seconds_between(kTransferStart, edge.t) > 30.0;
      return edge.channel == channel && is_late ? noise_s(rng) : 0.0;
    });
    ASSERT_TRUE(found) << name_of(channel);
    EXPECT_EQ(culprit_name_of(*found), name_of(channel));
    EXPECT_NEAR(std::get<double>(found->off.value), 18.0, 9.0);
    EXPECT_EQ(found->with.size(), channel == Sun2 ? 5U : 4U);
  }
}

TEST(ChannelContradictions, NameNoChannelWhereAllScatter) {
  std::mt19937_64 rng{48};
  std::normal_distribution<double> noise_s{0.0, 0.02};
  EXPECT_FALSE(found_with(40.0, [&](const Pulse& /*edge*/) { return noise_s(rng); }));
}

TEST(ChannelContradictions, FindNoneWhenTheBodyHasMoved) {
  Scene scene;
  SpinningBody moved = scene.body;
  moved.axis_icrf = Eigen::AngleAxisd{10.0 * kRadPerDeg, scene.body.axis_icrf.unitOrthogonal()} *
                    scene.body.axis_icrf;
  std::vector<Pulse> edges = scene.pulses(scene.body, 0.0, 30.0, scene.rng);
  const std::vector<Pulse> later = scene.pulses(moved, 30.0, 90.0, scene.rng);
  edges.insert(edges.end(), later.begin(), later.end());
  EXPECT_FALSE(found_in(observed(scene.body.config, scene.orbit, edges), scene.body.config));
}

}  // namespace spindrift::channel_contradictions_test
