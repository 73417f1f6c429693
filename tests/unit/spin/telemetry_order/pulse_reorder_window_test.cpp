#include "pipelines/spin/telemetry_order/pulse_reorder_window.h"

#include <algorithm>
#include <limits>
#include <random>
#include <vector>

#include "tests/support/matchers.h"

namespace spindrift::pulse_reorder_window_test {

using enum PulseChannel;
using enum ReorderWindow::Verdict;

constexpr std::int64_t kSecond_ns = 1'000'000'000;

Pulse pulse_at(std::int64_t t_ns, PulseChannel channel = Sun1) {
  return {.t = tai_from_ns(t_ns), .channel = channel};
}

/// Receives pulses and keeps what is released.
struct Receiver {
  ReorderWindow window;
  std::vector<Pulse> released;

  void receive(const Pulse& pulse) {
    ASSERT_EQ(window.offer(pulse), Held);
    const auto due = window.release();
    released.insert(released.end(), due.begin(), due.end());
  }
  /// Ends the stream and returns what is out of time.
  std::vector<Pulse> end() {
    const ReorderWindow::Rest rest = window.release_all();
    released.insert(released.end(), rest.in_time.begin(), rest.in_time.end());
    return rest.out_of_time;
  }
};

struct ReorderWindowTest : ::testing::Test {
  ReorderWindow window;
};

TEST_F(ReorderWindowTest, HoldsAPulseForOneSecondOfTelemetryTime) {
  EXPECT_EQ(window.offer(pulse_at(0)), Held);
  EXPECT_THAT(window.release(), IsEmpty());
  EXPECT_EQ(window.offer(pulse_at(kSecond_ns - 1)), Held);
  EXPECT_THAT(window.release(), IsEmpty());
  EXPECT_EQ(window.offer(pulse_at(kSecond_ns)), Held);
  EXPECT_THAT(window.release(), ElementsAre(pulse_at(0)));
}

TEST_F(ReorderWindowTest, GivesOutAllInTimeWhenTheStreamFallsSilent) {
  for (std::int64_t i = 0; i < 10; ++i) {
    window.offer(pulse_at(i * kSecond_ns));
    window.release();
  }
  window.offer(pulse_at(1000 * kSecond_ns));
  EXPECT_THAT(window.fall_silent(), ElementsAre(pulse_at(9 * kSecond_ns)));
  EXPECT_THAT(window.fall_silent(), IsEmpty());
  EXPECT_EQ(window.offer(pulse_at(9 * kSecond_ns - 1)), Late);
  EXPECT_EQ(window.offer(pulse_at(9 * kSecond_ns)), Duplicate);
  EXPECT_EQ(window.offer(pulse_at(9 * kSecond_ns + 1)), Held);
  EXPECT_EQ(window.release_all().out_of_time.size(), 1U);
}

TEST_F(ReorderWindowTest, GivesOutNothingOfTheFirstFewWhenTheStreamFallsSilent) {
  window.offer(pulse_at(2'000'000'000 * kSecond_ns));
  for (std::int64_t i = 0; i < 7; ++i) {
    window.offer(pulse_at(i));
    EXPECT_THAT(window.fall_silent(), IsEmpty());
  }
  window.offer(pulse_at(7));
  EXPECT_EQ(window.fall_silent().size(), 8U);
}

TEST_F(ReorderWindowTest, ReleasesInOrderOfTimeThenChannelAndKnowsADuplicateOfWhatItHolds) {
  EXPECT_EQ(window.offer(pulse_at(5, SouthOut)), Held);
  EXPECT_EQ(window.offer(pulse_at(5, SouthOut)), Duplicate);
  EXPECT_EQ(window.offer(pulse_at(5, Sun1)), Held);
  window.offer(pulse_at(3, NorthIn));
  window.offer(pulse_at(4, Sun2));
  EXPECT_THAT(window.release_all().in_time, ElementsAre(pulse_at(3, NorthIn), pulse_at(4, Sun2),
                                                        pulse_at(5, Sun1), pulse_at(5, SouthOut)));
  EXPECT_THAT(window.release_all().in_time, IsEmpty());
}

TEST(ReorderWindow, ABadClockMakesNothingLate) {
  constexpr std::int64_t kYears_ns = 2'000'000'000 * kSecond_ns;
  for (const std::int64_t bad_every : {3, 50}) {
    Receiver at;
    for (std::int64_t i = 0; i < 300; ++i) {
      at.receive(pulse_at(i * kSecond_ns / 5));
      if (i % bad_every == 1) {
        at.receive(pulse_at(kYears_ns + i * kSecond_ns));
      }
    }
    at.end();
    std::erase_if(at.released, [](const Pulse& pulse) { return pulse.t > tai_from_ns(kYears_ns); });
    ASSERT_EQ(at.released.size(), 300U);
    EXPECT_TRUE(std::ranges::is_sorted(at.released));
  }
}

TEST(ReorderWindow, ABadClockThatSpeaksFirstMakesNothingLate) {
  Receiver at;
  EXPECT_EQ(at.window.offer(pulse_at(2'000'000'000 * kSecond_ns)), Held);
  for (std::int64_t i = 0; i < 100; ++i) {
    at.receive(pulse_at(i * kSecond_ns / 5));
  }
  EXPECT_EQ(at.end().size(), 1U);
  EXPECT_EQ(at.released.size(), 100U);
}

TEST_F(ReorderWindowTest, FewFarAheadAtTheEndAreOutOfTime) {
  for (std::int64_t i = 0; i < 20; ++i) {
    window.offer(pulse_at(i * kSecond_ns));
    window.release();
  }
  for (std::int64_t i = 0; i < 7; ++i) {
    window.offer(pulse_at((1000 + i) * kSecond_ns));
    window.release();
  }
  const ReorderWindow::Rest rest = window.release_all();
  EXPECT_EQ(rest.in_time.back(), pulse_at(19 * kSecond_ns));
  EXPECT_EQ(rest.out_of_time.size(), 7U);
}

// A restarted service reads the samples back without their duplicates.
TEST_F(ReorderWindowTest, DuplicatesOfHeldSamplesChangeNothing) {
  for (std::int64_t i = 0; i < 8; ++i) {
    window.offer(pulse_at(i));
  }
  for (std::int64_t i = 0; i < 8; ++i) {
    EXPECT_EQ(window.offer(pulse_at((1000 + 3 * i) * kSecond_ns)), Held);
    EXPECT_EQ(window.offer(pulse_at(0)), Duplicate);
  }
  EXPECT_EQ(window.release().size(), 15U);
}

TEST(ReorderWindow, GoesOnAfterASilenceOfAnyLength) {
  Receiver at;
  for (std::int64_t i = 0; i < 20; ++i) {
    at.receive(pulse_at(i * kSecond_ns));
  }
  for (std::int64_t i = 0; i < 20; ++i) {
    at.receive(pulse_at((3600 + i) * kSecond_ns));
    EXPECT_EQ(at.released.size(), 19U) << "a clock may be wrong for so long";
  }
  at.receive(pulse_at(3620 * kSecond_ns));
  EXPECT_TRUE(std::ranges::is_sorted(at.released));
  EXPECT_EQ(at.released.size(), 40U);
  EXPECT_EQ(at.window.release_all().in_time.size(), 1U);
}

TEST_F(ReorderWindowTest, KnowsADuplicateOfWhatItReleasedWithinTenMinutes) {
  for (std::int64_t second = 0; second <= 602; ++second) {
    window.offer(pulse_at(second * kSecond_ns));
    window.release();
  }
  EXPECT_EQ(window.offer(pulse_at(0)), Late);
  EXPECT_EQ(window.offer(pulse_at(1 * kSecond_ns)), Duplicate);
  EXPECT_EQ(window.offer(pulse_at(601 * kSecond_ns)), Duplicate);
  EXPECT_EQ(window.offer(pulse_at(300 * kSecond_ns + 1)), Late);
}

TEST_F(ReorderWindowTest, WhatPrecedesAReleasedPulseIsLate) {
  window.offer(pulse_at(10, Sun2));
  window.offer(pulse_at(10 + kSecond_ns));
  EXPECT_THAT(window.release(), ElementsAre(pulse_at(10, Sun2)));
  EXPECT_EQ(window.offer(pulse_at(9)), Late);
  EXPECT_EQ(window.offer(pulse_at(10, Sun1)), Late);
  EXPECT_EQ(window.offer(pulse_at(10, NorthIn)), Held);
}

TEST_F(ReorderWindowTest, ALatePulseIsNeverReleased) {
  window.offer(pulse_at(2 * kSecond_ns));
  window.offer(pulse_at(4 * kSecond_ns));
  window.release();
  window.offer(pulse_at(kSecond_ns));
  EXPECT_THAT(window.release_all().in_time, ElementsAre(pulse_at(4 * kSecond_ns)));
}

TEST(ReorderWindow, DisorderWithinOneSecondIsSortedWithoutLoss) {
  std::mt19937_64 rng{31};
  std::uniform_int_distribution<std::int64_t> gap_ns{0, kSecond_ns / 4};
  std::uniform_int_distribution<std::int64_t> delay_ns{0, kSecond_ns - 1};
  std::uniform_int_distribution<int> channel{0, static_cast<int>(kPulseChannels) - 1};
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<Pulse> sent;
    std::int64_t t_ns = 0;
    for (int i = 0; i < 300; ++i) {
      t_ns += 1 + gap_ns(rng);
      sent.push_back(pulse_at(t_ns, static_cast<PulseChannel>(channel(rng))));
    }
    std::vector<std::pair<std::int64_t, Pulse>> arrivals(sent.size());
    std::transform(sent.begin(), sent.end(), arrivals.begin(), [&](const Pulse& pulse) {
      return std::pair{tai_ns(pulse.t) + delay_ns(rng), pulse};
    });
    std::ranges::sort(arrivals);

    Receiver at;
    for (const auto& [arrival_ns, pulse] : arrivals) {
      at.receive(pulse);
    }
    at.end();
    ASSERT_EQ(at.released, sent) << "trial " << trial;
  }
}

TEST(ReorderWindow, TheEndsOfTimeDoNotOverflow) {
  constexpr std::int64_t kLeast_ns = std::numeric_limits<std::int64_t>::min();
  constexpr std::int64_t kMost_ns = std::numeric_limits<std::int64_t>::max();
  ReorderWindow window;
  std::size_t out = 0;
  for (std::int64_t i = 0; i < 20; ++i) {
    window.offer(pulse_at(kLeast_ns + i));
    window.offer(pulse_at(kMost_ns - i));
    out += window.release().size();
  }
  const ReorderWindow::Rest rest = window.release_all();
  EXPECT_EQ(out + rest.in_time.size() + rest.out_of_time.size(), 40U);
}

TEST(ReorderWindow, AFewFarBeforeTheFirstRunAreLeftOut) {
  constexpr std::int64_t kPass_ns = 1'795'143'637 * kSecond_ns;
  const std::vector<Pulse> strays = {pulse_at(63'158'400 * kSecond_ns),
                                     pulse_at(946'684'800 * kSecond_ns)};
  for (const std::size_t place : {std::size_t{0}, std::size_t{2}}) {
    std::vector<Pulse> pulses;
    for (std::int64_t i = 0; i < 40; ++i) {
      pulses.push_back(pulse_at(kPass_ns + i * kSecond_ns / 5));
    }
    const std::vector<Pulse> pass = pulses;
    pulses.insert(pulses.begin() + static_cast<std::ptrdiff_t>(place), strays.begin(),
                  strays.end());
    Receiver at;
    for (const Pulse& pulse : pulses) {
      at.receive(pulse);
    }
    EXPECT_GT(at.released.size(), 30U) << "not held until the end";
    EXPECT_EQ(at.end(), strays) << place;
    EXPECT_EQ(at.released, pass) << place;
  }
}

TEST_F(ReorderWindowTest, ADuplicateDoesNotSpeakAgainstAJump) {
  window.offer(pulse_at(0));
  for (std::int64_t i = 0; i < 8; ++i) {
    EXPECT_EQ(window.offer(pulse_at(0)), Duplicate);
    EXPECT_EQ(window.offer(pulse_at((100 + 3 * i) * kSecond_ns)), Held);
  }
  EXPECT_THAT(window.release(), ::testing::Contains(pulse_at(100 * kSecond_ns)));
}

}  // namespace spindrift::pulse_reorder_window_test
