#include "pipelines/spin/telemetry_order/time_grid.h"

#include <cstdint>
#include <random>

#include "tests/support/matchers.h"

namespace spindrift::time_grid_test {

constexpr PulseNoise kNoise{.sun_s = 1e-4, .infrared_s = 5e-4};
constexpr std::int64_t kStart_ns = 1'795'143'637'000'000'000;
constexpr std::int64_t kTurn_ns = 1'000'000'000;

/// Simulates six channels at 60 rpm with the stated noise.
class Train {
 public:
  /// @param cut Number of channels whose times are truncated, sun1 first.
  explicit Train(std::int64_t grid_ns, std::size_t cut = kPulseChannels)
      : grid_ns_{grid_ns}, cut_{cut} {}

  /// Adds a turn.
  /// @param steps_ns Step of the delays after sun1, as from on-board counters.
  void turn(TimeGrid& grid, std::int64_t steps_ns = 1) {
    const std::int64_t sun1_ns = on_grid(kStart_ns + turns_++ * kTurn_ns + noise_ns(kNoise.sun_s));
    grid.learn({.t = tai_from_ns(sun1_ns), .channel = PulseChannel::Sun1});
    for (std::size_t i = 1; i < kPulseChannels; ++i) {
      const auto channel = static_cast<PulseChannel>(i);
      const std::int64_t delay_ns =
          static_cast<std::int64_t>(i) * 123'456'789 + noise_ns(edge_sigma_s(kNoise, channel));
      const std::int64_t counted_ns = delay_ns / steps_ns * steps_ns;
      grid.learn({.t = tai_from_ns(i < cut_ ? on_grid(sun1_ns + counted_ns) : sun1_ns + counted_ns),
                  .channel = channel});
    }
  }

  /// Adds turns and returns the width of the grid then, s.
  double width_after_s(int turns, TimeGrid& grid, std::int64_t steps_ns = 1) {
    for (int i = 0; i < turns; ++i) {
      turn(grid, steps_ns);
    }
    return grid.width_s();
  }

 private:
  std::int64_t on_grid(std::int64_t t_ns) const { return t_ns / grid_ns_ * grid_ns_; }
  std::int64_t noise_ns(double sigma_s) {
    return static_cast<std::int64_t>(1e9 * sigma_s * normal_(rng_));
  }

  std::int64_t grid_ns_;
  std::size_t cut_;
  std::int64_t turns_ = 0;
  std::mt19937_64 rng_{7};
  std::normal_distribution<double> normal_;
};

TEST(TimeGrid, IsFoundBeforeAnAnswerMayBeOk) {
  for (const std::int64_t grid_ns : {1'000, 100'000, 1'000'000, 10'000'000}) {
    Train train{grid_ns};
    TimeGrid grid{kNoise};
    EXPECT_EQ(train.width_after_s(1, grid), 0.0);
    EXPECT_DOUBLE_EQ(train.width_after_s(11, grid), 1e-9 * static_cast<double>(grid_ns));
  }
}

TEST(TimeGrid, IsNoneOfNanosecondsNorOfLessThanAThousandthOfTheNoise) {
  for (const std::int64_t grid_ns : {1, 100}) {
    TimeGrid grid{kNoise};
    EXPECT_EQ(Train{grid_ns}.width_after_s(10'000, grid), 0.0);
  }
}

TEST(TimeGrid, IsNotHiddenByEdgesOfAnotherClock) {
  Train train{1'000'000};
  TimeGrid grid{kNoise};
  std::int64_t stray_ns = kStart_ns + 17;
  for (int turn = 0; turn < 60; ++turn) {
    train.turn(grid);
    if (turn % 7 == 0) {
      stray_ns += 7 * kTurn_ns + 31;
      grid.learn({.t = tai_from_ns(stray_ns), .channel = PulseChannel::NorthIn});
    }
  }
  EXPECT_DOUBLE_EQ(grid.width_s(), 1e-3);
}

TEST(TimeGrid, IsThatOfTheDelaysOfFramesWhoseSun1HasNone) {
  TimeGrid grid{kNoise};
  EXPECT_DOUBLE_EQ(Train{1}.width_after_s(12, grid, 1'000'000), 1e-3);
}

TEST(TimeGrid, MayBeOfSomeChannelsOnly) {
  for (const std::size_t cut : {1U, 2U, 3U}) {
    TimeGrid grid{kNoise};
    EXPECT_DOUBLE_EQ((Train{1'000'000, cut}.width_after_s(42, grid)), 1e-3) << cut;
  }
}

/// Noise-free edges at a round rate, some lost, are no grid.
TEST(TimeGrid, IsNoneOfTurnsOfOneLength) {
  TimeGrid grid{kNoise};
  for (std::int64_t turn = 0; turn < 1'000; turn += turn % 7 == 0 ? 2 : 1) {
    grid.learn({.t = tai_from_ns(kStart_ns + turn * kTurn_ns), .channel = PulseChannel::Sun1});
  }
  EXPECT_EQ(grid.width_s(), 0.0);
}

TEST(TimeGrid, MayBeginInThePass) {
  TimeGrid grid{kNoise};
  EXPECT_EQ(Train{1}.width_after_s(100, grid), 0.0);
  EXPECT_DOUBLE_EQ(Train{1'000'000}.width_after_s(14, grid), 1e-3);
}

/// The pass has 6,000 runs; by chance one in eleven such passes has a run with twice the width.
TEST(TimeGrid, StaysAsWideAsItIs) {
  TimeGrid grid{kNoise};
  EXPECT_DOUBLE_EQ(Train{100'000}.width_after_s(20'000, grid), 1e-4);
}

}  // namespace spindrift::time_grid_test
