#include "pipelines/spin/telemetry_order/interference.h"

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "pipelines/time/time_span.h"
#include "tests/support/matchers.h"

namespace spindrift::interference_test {

using enum PulseChannel;

constexpr double kWindow_s = 1e-3;
constexpr std::int64_t kMicrosecond_ns = 1000;

Pulse pulse_at(std::int64_t t_us, PulseChannel channel) {
  return {.t = tai_from_ns(t_us * kMicrosecond_ns), .channel = channel};
}

struct Sorted {
  std::vector<Pulse> clean;
  std::vector<Pulse> spoilt;
};

Sorted sorted(double window_s, const std::vector<Pulse>& pulses) {
  InterferenceWindow window{window_s};
  Sorted all;
  const auto collect = [&](const std::vector<InterferenceWindow::Judged>& some) {
    for (const auto& [pulse, spoilt] : some) {
      (spoilt ? all.spoilt : all.clean).push_back(pulse);
    }
  };
  for (const Pulse& pulse : pulses) {
    collect(window.push(pulse));
  }
  collect(window.finish());
  return all;
}

TEST(Interference, EdgesOfDifferentChannelsCloserThanTheWindowSpoilEachOther) {
  const auto [clean, spoilt] = sorted(kWindow_s, {pulse_at(0, Sun1), pulse_at(5000, NorthIn),
                                                  pulse_at(5999, SouthIn), pulse_at(9000, Sun2)});
  EXPECT_THAT(clean, ElementsAre(pulse_at(0, Sun1), pulse_at(9000, Sun2)));
  EXPECT_THAT(spoilt, ElementsAre(pulse_at(5000, NorthIn), pulse_at(5999, SouthIn)));
}

TEST(Interference, SaysHowNearTheEdgeIsThatSpoilsAnother) {
  InterferenceWindow window{kWindow_s};
  std::vector<double> gaps_s;
  for (const auto& [t_us, channel] :
       {std::pair{0, NorthIn}, std::pair{700, Sun1}, std::pair{900, SouthIn}}) {
    EXPECT_THAT(window.push(pulse_at(t_us, channel)), IsEmpty());
  }
  for (const auto& judged : window.finish()) {
    EXPECT_EQ(judged.spoilt_by.value().least_s, kWindow_s);
    gaps_s.push_back(judged.spoilt_by->gap_s);
  }
  EXPECT_THAT(gaps_s, ElementsAre(::testing::DoubleEq(7e-4), ::testing::DoubleEq(7e-4),
                                  ::testing::DoubleEq(2e-4)));
}

TEST(Interference, SpoilsAllOfAChainOrNothing) {
  const std::vector<std::pair<std::vector<Pulse>, bool>> all_edges = {
      // The window itself is not closer, and edges of one channel do not spoil each other.
      {{pulse_at(0, Sun1), pulse_at(1000, Sun2)}, false},
      {{pulse_at(0, Sun1), pulse_at(100, Sun1)}, false},
      // A chain is spoilt as a whole, and an edge of the same channel in between hides nothing.
      {{pulse_at(0, NorthIn), pulse_at(800, SouthIn), pulse_at(1600, NorthIn),
        pulse_at(2400, Sun1)},
       true},
      {{pulse_at(0, NorthIn), pulse_at(300, SouthIn), pulse_at(600, SouthIn)}, true}};
  for (const auto& [edges, is_spoilt] : all_edges) {
    EXPECT_EQ(sorted(kWindow_s, edges).spoilt, is_spoilt ? edges : std::vector<Pulse>{});
  }
}

TEST(Interference, WithoutAWindowEverythingPassesAtOnce) {
  InterferenceWindow window{0.0};
  for (const PulseChannel channel : {Sun1, Sun2}) {
    const InterferenceWindow::Judged clean{.pulse = pulse_at(0, channel), .spoilt_by = {}};
    EXPECT_THAT(window.push(clean.pulse), ElementsAre(clean));
  }
  EXPECT_THAT(window.finish(), IsEmpty());
}

TEST(Interference, SpoiltEdgesComeOutInOrderAmongTheOthers) {
  InterferenceWindow window{kWindow_s};
  std::vector<InterferenceWindow::Judged> all;
  for (const Pulse& pulse : {pulse_at(0, Sun1), pulse_at(2000, NorthIn), pulse_at(2400, SouthIn),
                             pulse_at(5000, Sun2)}) {
    const auto some = window.push(pulse);
    all.insert(all.end(), some.begin(), some.end());
  }
  const EdgeGap gap{.gap_s = elapsed_s(tai_from_ns(0), tai_from_ns(400 * kMicrosecond_ns)),
                    .least_s = kWindow_s};
  EXPECT_THAT(all, ElementsAre(InterferenceWindow::Judged{pulse_at(0, Sun1), {}},
                               InterferenceWindow::Judged{pulse_at(2000, NorthIn), gap},
                               InterferenceWindow::Judged{pulse_at(2400, SouthIn), gap}));
}

// The test ends only if the cost of an edge does not grow with the number of held edges.
TEST(Interference, AFloodWithinOneWindowComesOutWholeAndInOrder) {
  constexpr std::size_t kFlood = 1'000'000;
  std::vector<Pulse> flood(kFlood);
  for (std::size_t i = 0; i < kFlood; ++i) {
    flood[i] = {.t = tai_from_ns(static_cast<std::int64_t>(i / 2)),
                .channel = i % 2 == 0 ? Sun1 : Sun2};
  }
  EXPECT_EQ(sorted(kWindow_s, flood).spoilt, flood);
  for (Pulse& pulse : flood) {
    pulse.channel = Sun1;
  }
  EXPECT_EQ(sorted(kWindow_s, flood).clean, flood);
  flood.back().channel = Sun2;
  EXPECT_EQ(sorted(kWindow_s, flood).spoilt, flood);
}

}  // namespace spindrift::interference_test
