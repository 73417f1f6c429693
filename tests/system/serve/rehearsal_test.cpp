// `replay --now` and `simulate --publish --now`: rehearsals in which the clock follows the pass.

#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <string>

#include "pipelines/time/tai_time.h"
#include "services/base/wall_clock.h"
#include "services/ingest/rehearsal_clocks.h"
#include "tests/support/archive_rows.h"
#include "tests/support/bus_fixture.h"
#include "tests/support/on_bus.h"
#include "tests/support/program.h"
#include "tests/support/ran.h"
#include "tests/support/recorded_files.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_paths.h"

namespace spindrift::rehearsal_test {

/// On an idle machine the difference to the sender's clock is a few milliseconds.
constexpr double kSlack_s = 30.0;

/// Runs a service and observes the clocks of rehearsals on its bus.
class Rehearsal : public ::testing::Test {
 protected:
  double offset_s() {
    EXPECT_TRUE(
        eventually([&] { return clocks_.look() && clocks_.offset("SPINNER").has_value(); }));
    const std::chrono::duration<double> offset =
        clocks_.offset("SPINNER").value_or(std::chrono::nanoseconds{0});
    return offset.count();
  }
  std::string domain() const { return std::to_string(service_.bus().domain); }
  /// Returns a number from the service's archive.
  std::int64_t number(const std::string& query) { return number_of(service_.db(), query); }
  void stop(Program& sender) {
    sender.signal(SIGINT);
    EXPECT_EQ(sender.exit_status(), 1);
    EXPECT_EQ(service_.stop(), 0);
  }

  ReadyService service_{"nominal", "replay"};
  bus::Participant participant_ = bus::Participant::create(service_.bus()).value();
  RehearsalClocks clocks_ = RehearsalClocks::create(participant_).value();
};

TEST_F(Rehearsal, OfARecordedPassTellsHowFarItIsInThePast) {
  Program replay{service_.words({"replay", "--now", "--telemetry", kPasses / "nominal"})};
  const auto first = [&] { return number("SELECT ifnull(min(t_tai_ns), 0) FROM pulse"); };
  ASSERT_TRUE(eventually([&] { return first() > 0; })) << replay.log();
  EXPECT_NEAR(offset_s(), seconds_between(tai_from_ns(first()), tai_now()), kSlack_s);
  stop(replay);
}

TEST_F(Rehearsal, OfASimulatedPassIsOfThePresent) {
  const TaiTime before = tai_now();
  Program simulate{
      {"simulate", scenarios() / "gto-nominal.toml", "--publish", "--now", "--domain", domain()}};
  const auto last = [&] { return number("SELECT ifnull(max(t_tai_ns), 0) FROM pulse"); };
  ASSERT_TRUE(eventually([&] { return last() > 0; })) << simulate.log();
  EXPECT_EQ(offset_s(), 0.0);
  EXPECT_GT(tai_from_ns(last()), before);
  EXPECT_LE(tai_from_ns(last()), tai_now());
  stop(simulate);
}

TEST(SimulatedRehearsal, GivesTheServiceOfItsMissionFileAnAxis) {
  const TemporaryFolder folder;
  const auto mission = folder.path() / "pass" / "mission.toml";
  const auto db = folder.path() / "served.db";
  const bus::BusConfig bus = bus_of_its_own();
  const std::string domain = std::to_string(bus.domain);
  Program simulate{{"simulate", scenarios() / "gto-nominal.toml", "--publish", "--now", "--out",
                    mission.parent_path(), "--domain", domain}};
  ASSERT_TRUE(eventually([&] { return std::filesystem::exists(mission); })) << simulate.log();
  Serving service{
      {"serve", "--mission", mission, "--db", db, "--domain", domain, "--partition", "replay"}};
  EXPECT_TRUE(eventually([&] {
    return count_rows(db, "spin_estimate WHERE quality <> 'DOUBTFUL'") > 0;
  })) << service.log();
  EXPECT_EQ(count_rows(db, "pulse_use WHERE rejected_by = 'no_orbit'"), 0);
  EXPECT_EQ(count_rows(db, "alert WHERE key = 'data.outdated:orbit'"), 0);
  simulate.signal(SIGINT);
  EXPECT_EQ(simulate.exit_status(), 1);
  stop_in_order(service);
}

TEST(RehearsalsCommand, IsAtTheSpeedOfTheClock) {
  refused({"replay", "--now", "--speed", "2", "--mission", "m.toml", "--telemetry", "."}, {});
  refused({"simulate", "s.toml", "--out", "x", "--now"}, {});
}

}  // namespace spindrift::rehearsal_test
