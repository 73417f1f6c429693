// What is stored of alerts that come and go.

#include <SQLiteCpp/Database.h>

#include <chrono>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "services/alerts/alert_desk.h"
#include "services/alerts/stored_alerts.h"
#include "tests/integration/archive_fixture.h"
#include "tests/support/matchers.h"
#include "tests/support/recorded_files.h"

namespace spindrift::alert_rows_test {

constexpr std::int64_t kStart_ns = 1'795'143'637'000'000'000;

class AlertRows : public testing::ArchiveFixture {
 protected:
  AlertRows() : archive_{open()} {
    ArchiveBatch start = testing::start_of("run-1");
    start.start->mode = RunMode::Live;
    desk_->evaluate(start);
    commit(*archive_, start);
    desk_->note_stored({&start, 1});
  }

  void restart() {
    desk_ = new_desk();
    ArchiveBatch goes_on{.run_id = "run-1", .spacecraft_id = "SPINNER"};
    goes_on.continuation.emplace();
    desk_->evaluate(goes_on);
    desk_->note_stored({&goes_on, 1});
    const auto alerts = find_alerts(path()).value();
    for (const StoredAlert& stored : alerts) {
      desk_->take_up(stored.spacecraft, stored.run_id, stored.alert);
    }
    const auto transitions = find_transitions(path(), RunMode::Live).value();
    for (const auto& [spacecraft, t] : transitions) {
      desk_->take_up_transition(spacecraft, t);
    }
  }

  /// Stores what a link raises and clears that has been silent for so long.
  void silent(double t_s, double silent_s) {
    const TaiTime t = shifted(tai_from_ns(kStart_ns), t_s);
    commit(*archive_,
           desk_->evaluate({{"SPINNER", {.t = t, .pass_t = t, .silent_s = silent_s}}}, t));
  }
  void flap(int times, double every_s) {
    for (int i = 0; i < times; ++i) {
      silent(i * every_s, 6.0);
      silent((i + 0.5) * every_s, 0.0);
    }
  }

  static std::unique_ptr<AlertDesk> new_desk() {
    return std::make_unique<AlertDesk>(
        std::vector{load_mission(kPasses / "nominal" / "mission.toml").value()}, RunMode::Live);
  }

  std::unique_ptr<AlertDesk> desk_ = new_desk();
  std::unique_ptr<Archive> archive_;
};

TEST_F(AlertRows, AConditionThatFlapsForTenMinutesIsOneOccurrenceThatIsCounted) {
  flap(150, 4.0);
  EXPECT_EQ(count("alert"), 1);
  EXPECT_EQ(number("SELECT count FROM alert"), 150);
  EXPECT_EQ(text("SELECT state FROM alert"), "cleared");
  EXPECT_EQ(number("SELECT raised_tai_ns FROM alert"), kStart_ns);
  EXPECT_EQ(count("alert_transition"), 300);
  EXPECT_EQ(count("alert_transition WHERE from_state = 'cleared' AND to_state = 'active'"), 149);
  EXPECT_EQ(number("SELECT evidence ->> 'count' FROM alert"), 150);
}

TEST_F(AlertRows, AWordThatHasWaitedBehindOthersIsAnsweredFiveSecondsAfterItWasSaid) {
  using namespace std::chrono_literals;
  silent(0.0, 6.0);
  const auto begun = std::chrono::steady_clock::now();
  SQLite::Database other{path().string(), SQLite::OPEN_READWRITE};
  other.exec("BEGIN IMMEDIATE");
  EXPECT_THAT(take_word({.alert_id = text("SELECT alert_id FROM alert"),
                         .by = "shift",
                         .note = "seen",
                         .said = begun - 4900ms},
                        *desk_, *archive_),
              IsRefused(ErrorCode::Unavailable, HasSubstr("not stored within 5 s")));
  EXPECT_LT(std::chrono::steady_clock::now() - begun, 3s);
  other.exec("ROLLBACK");
  EXPECT_TRUE(archive_->flush());
  EXPECT_EQ(text("SELECT state FROM alert"), "acknowledged");
}

TEST_F(AlertRows, AreAtMostAThousandAnHourWhateverHappens) {
  flap(3600, 1.0);
  EXPECT_EQ(count("alert"), 1);
  EXPECT_EQ(count("alert_transition"), 500);
  silent(3600.5, 0.0);
  silent(7201.0, 0.0);
  EXPECT_EQ(number("SELECT count FROM alert"), 3600);
  EXPECT_EQ(text("SELECT state FROM alert"), "cleared");
  EXPECT_EQ(count("alert_transition WHERE note LIKE '%changes before it are left out%'"), 1);
}

TEST_F(AlertRows, AreAtMostAThousandAnHourAlsoOverARestart) {
  flap(400, 1.0);
  restart();
  flap(3600, 1.0);
  EXPECT_EQ(count("alert_transition"), 500);
}

}  // namespace spindrift::alert_rows_test
