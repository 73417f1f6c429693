#include "pipelines/spin/pass/only_axis.h"

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

#include "pipelines/frames/angle.h"
#include "pipelines/frames/celestial.h"
#include "pipelines/spin/consistency/channel_block.h"
#include "tests/support/observed_spin.h"
#include "tests/support/recorded_pass.h"

namespace spindrift::testing::only_axis_test {

using enum PulseChannel;

/// Returns the blocks of a recorded pass without some channels.
std::vector<BlockUnderSky> blocks_of(const RecordedPass& pass,
                                     const std::set<PulseChannel>& without, double from_s,
                                     double to_s) {
  std::vector<Pulse> pulses = pass.pulses;
  std::erase_if(pulses, [&](const Pulse& pulse) {
    const double t_s = seconds_between(pass.pulses.front().t, pulse.t);
    return without.contains(pulse.channel) || t_s < from_s || t_s > to_s;
  });
  std::vector<BlockUnderSky> blocks;
  BlockCollector collector;
  for (const auto& [revolution, sky] : observed(pass.config, pass.orbit, std::move(pulses))) {
    if (const auto block = collector.add(pass.config.noise, revolution)) {
      blocks.push_back({.block = *block, .sky = sky_at(pass.orbit, block->t)});
    }
  }
  return blocks;
}

std::optional<Eigen::Vector3d> searched(const RecordedPass& pass,
                                        const std::vector<BlockUnderSky>& blocks) {
  OnlyAxis only;
  for (const BlockUnderSky& block : blocks) {
    only.add(block);
  }
  return only.search(pass.config);
}

TEST(OnlyAxis, IsFoundOnceTheEarthHasMovedEnough) {
  const RecordedPass pass = recorded_pass("nominal");
  const std::set<PulseChannel> without{Sun2, NorthIn, NorthOut};
  EXPECT_FALSE(searched(pass, blocks_of(pass, without, 0.0, 100.0)));
  const auto found_icrf = searched(pass, blocks_of(pass, without, 0.0, 300.0));
  ASSERT_TRUE(found_icrf);
  EXPECT_LT(angle_between_rad(*found_icrf, pass.true_axis_icrf), kRadPerDeg);
}

TEST(OnlyAxis, IsNoneWhereNoAxisExplainsTheEdges) {
  RecordedPass pass = recorded_pass("nominal");
  for (Pulse& pulse : pass.pulses) {
    if (pulse.channel == SouthIn && seconds_between(pass.pulses.front().t, pulse.t) > 150.0) {
      pulse.t = shifted(pulse.t, 0.05);
    }
  }
  EXPECT_FALSE(searched(pass, blocks_of(pass, {Sun2}, 0.0, 300.0)));
}

TEST(OnlyAxis, IsSearchedAgainAsTheBlocksBecomeMore) {
  const RecordedPass pass = recorded_pass("nominal");
  OnlyAxis only;
  std::vector<std::size_t> found_at;
  std::size_t count = 0;
  for (const BlockUnderSky& block : blocks_of(pass, {}, 0.0, 100.0)) {
    only.add(block);
    ++count;
    if (only.search(pass.config)) {
      found_at.push_back(count);
    }
  }
  EXPECT_EQ(found_at, (std::vector<std::size_t>{8, 10, 12, 15}));
}

}  // namespace spindrift::testing::only_axis_test
