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
#include "tests/support/program.h"
#include "tests/support/service.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_paths.h"

namespace spindrift::rehearsal_test {

/// On an idle machine the difference to the sender's clock is a few milliseconds.
constexpr double kSlack_s = 30.0;

/// Runs a service and observes the clocks of rehearsals on its bus.
class Rehearsal : public ::testing::Test {
 protected:
  Rehearsal() { EXPECT_TRUE(service_.ready()); }

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

  Service service_{"nominal", "replay"};
  bus::Participant participant_ = bus::Participant::create(service_.bus()).value();
  RehearsalClocks clocks_ = RehearsalClocks::create(participant_).value();
};

TEST_F(Rehearsal, OfARecordedPassTellsHowFarItIsInThePast) {
  Program replay{{"replay", "--now", "--mission", service_.mission(), "--telemetry",
                  (kPasses / "nominal").string(), "--domain", domain()}};
  const auto first = [&] { return number("SELECT ifnull(min(t_tai_ns), 0) FROM pulse"); };
  ASSERT_TRUE(eventually([&] { return first() > 0; })) << replay.log();
  EXPECT_NEAR(offset_s(), seconds_between(tai_from_ns(first()), tai_now()), kSlack_s);
  stop(replay);
}

TEST_F(Rehearsal, OfASimulatedPassIsOfThePresent) {
  const TaiTime before = tai_now();
  Program simulate{{"simulate", (scenarios() / "gto-nominal.toml").string(), "--publish", "--now",
                    "--domain", domain()}};
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
  Program simulate{{"simulate", (scenarios() / "gto-nominal.toml").string(), "--publish", "--now",
                    "--out", mission.parent_path().string(), "--domain", domain}};
  ASSERT_TRUE(eventually([&] { return std::filesystem::exists(mission); })) << simulate.log();
  Program service{{"serve", "--mission", mission.string(), "--db", db.string(), "--domain", domain,
                   "--partition", "replay"}};
  ASSERT_TRUE(service.says("ready")) << service.log();
  EXPECT_TRUE(eventually([&] {
    return number_of(db, "SELECT count(*) FROM spin_estimate WHERE quality <> 'DOUBTFUL'") > 0;
  })) << service.log();
  EXPECT_EQ(number_of(db, "SELECT count(*) FROM pulse_use WHERE rejected_by = 'no_orbit'"), 0);
  EXPECT_EQ(number_of(db, "SELECT count(*) FROM alert WHERE key = 'data.outdated:orbit'"), 0);
  simulate.signal(SIGINT);
  EXPECT_EQ(simulate.exit_status(), 1);
  service.signal(SIGTERM);
  EXPECT_EQ(service.exit_status(), 0);
}

TEST(RehearsalsCommand, IsAtTheSpeedOfTheClock) {
  Program replay{{"replay", "--now", "--speed", "2", "--mission", "m.toml", "--telemetry", "."}};
  EXPECT_EQ(replay.exit_status(), 2);
  Program simulate{{"simulate", "s.toml", "--out", "x", "--now"}};
  EXPECT_EQ(simulate.exit_status(), 2);
}

}  // namespace spindrift::rehearsal_test
