// `replay --now` and `simulate --publish --now`: a rehearsal whose clock is that of the pass.

#include <gtest/gtest.h>

#include <chrono>
#include <string>

#include "pipelines/time/tai_time.h"
#include "services/clock/wall_clock.h"
#include "services/ingest/rehearsal_clocks.h"
#include "tests/support/archive_rows.h"
#include "tests/support/bus_fixture.h"
#include "tests/support/program.h"
#include "tests/support/service.h"
#include "tests/support/test_paths.h"

namespace spindrift::rehearsal_test {

/// Beside a sender on an idle machine it is milliseconds.
constexpr double kSlack_s = 30.0;

double offset_s(RehearsalClocks& clocks, const std::string& spacecraft) {
  EXPECT_TRUE(eventually([&] { return clocks.look() && clocks.offset(spacecraft).has_value(); }));
  const std::chrono::duration<double> offset =
      clocks.offset(spacecraft).value_or(std::chrono::nanoseconds{0});
  return offset.count();
}

TEST(Rehearsal, OfARecordedPassTellsHowFarItIsInThePast) {
  Service service{"nominal", "replay"};
  ASSERT_TRUE(service.ready());
  const auto participant = bus::Participant::create(service.bus());
  ASSERT_TRUE(participant);
  auto clocks = RehearsalClocks::create(*participant);
  ASSERT_TRUE(clocks);
  Program replay{{"replay", "--now", "--mission", service.mission(), "--telemetry",
                  (kPasses / "nominal").string(), "--domain",
                  std::to_string(service.bus().domain)}};
  const auto first = [&] {
    return number_of(service.db(), "SELECT ifnull(min(t_tai_ns), 0) FROM pulse");
  };
  ASSERT_TRUE(eventually([&] { return first() > 0; })) << replay.log();
  EXPECT_NEAR(offset_s(*clocks, "SPINNER"), seconds_between(tai_from_ns(first()), tai_now()),
              kSlack_s);
  replay.signal(SIGINT);
  EXPECT_EQ(replay.exit_status(), 1);
  EXPECT_EQ(service.stop(), 0);
}

TEST(Rehearsal, OfASimulatedPassIsOfThePresent) {
  Service service{"nominal", "replay"};
  ASSERT_TRUE(service.ready());
  const auto participant = bus::Participant::create(service.bus());
  ASSERT_TRUE(participant);
  auto clocks = RehearsalClocks::create(*participant);
  ASSERT_TRUE(clocks);
  const TaiTime before = tai_now();
  Program simulate{{"simulate", (scenarios() / "gto-nominal.toml").string(), "--publish", "--now",
                    "--domain", std::to_string(service.bus().domain)}};
  const auto last = [&] {
    return number_of(service.db(), "SELECT ifnull(max(t_tai_ns), 0) FROM pulse");
  };
  ASSERT_TRUE(eventually([&] { return last() > 0; })) << simulate.log();
  EXPECT_EQ(offset_s(*clocks, "SPINNER"), 0.0);
  EXPECT_GT(tai_from_ns(last()), before);
  EXPECT_LE(tai_from_ns(last()), tai_now());
  simulate.signal(SIGINT);
  EXPECT_EQ(simulate.exit_status(), 1);
  EXPECT_EQ(service.stop(), 0);
}

TEST(Rehearsal, IsAtTheSpeedOfTheClock) {
  Program replay{{"replay", "--now", "--speed", "2", "--mission", "m.toml", "--telemetry", "."}};
  EXPECT_EQ(replay.exit_status(), 2);
  Program simulate{{"simulate", "s.toml", "--out", "x", "--now"}};
  EXPECT_EQ(simulate.exit_status(), 2);
}

}  // namespace spindrift::rehearsal_test
