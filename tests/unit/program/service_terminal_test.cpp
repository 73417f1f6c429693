#include "services/program/service_terminal.h"

#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>

#include <memory>
#include <optional>
#include <sstream>
#include <utility>

#include "tests/support/matchers.h"

namespace spindrift::service_terminal_test {

/// Collects the messages of a service without a terminal.
class Told : public ::testing::Test {
 protected:
  Told() {
    spdlog::set_default_logger(std::make_shared<spdlog::logger>(
        "told", std::make_shared<spdlog::sinks::ostream_sink_mt>(log_)));
    spdlog::set_pattern("%l %v");
  }
  ~Told() override { spdlog::set_default_logger(std::move(before_)); }

  /// Returns the messages since the last call.
  std::string said() { return std::exchange(log_, std::ostringstream{}).str(); }
  void tell(std::optional<AlertState> from, AlertState state) {
    silence_.from = from;
    silence_.state = state;
    terminal_.tell("SPINNER", "run", silence_);
  }
  void show_silence_of(double age_s) {
    Health health{};
    health.spacecraft = {{.spacecraft = "SPINNER",
                          .link = LinkState::Stale,
                          .last_sample = TaiTime{},
                          .data_age_s = age_s}};
    terminal_.show(health);
  }

  std::shared_ptr<spdlog::logger> before_ = spdlog::default_logger();
  std::ostringstream log_;
  const std::vector<Mission> missions_;
  ServiceTerminal terminal_{missions_, TellAs::Lines};
  Alert silence_{.alert_id = "00ff",
                 .key = "link.silent",
                 .severity = AlertSeverity::Warning,
                 .message = "no telemetry: 5.1 s"};
};

TEST_F(Told, SaysEachChangeOfAnAlertOnce) {
  terminal_.tell("SPINNER", "run", silence_);
  EXPECT_EQ(said(), "warning SPINNER: link.silent: no telemetry: 5.1 s\n");
  silence_.by = "shift";
  silence_.note = "seen\x1b[2J";
  tell(AlertState::Active, AlertState::Acknowledged);
  EXPECT_EQ(said(), "info SPINNER: link.silent: acknowledged by shift: seen\\x1b[2J\n");
  silence_.note = "over at 2026";
  tell(AlertState::Active, AlertState::Cleared);
  EXPECT_EQ(said(), "info SPINNER: link.silent: over at 2026\n");
  tell(AlertState::Cleared, AlertState::Active);
  EXPECT_EQ(said(), "warning SPINNER: link.silent: no telemetry: 5.1 s\n");
  silence_.by = "";
  tell(AlertState::Active, AlertState::Active);
  EXPECT_EQ(said(), "");
}

TEST_F(Told, DoesNotSayThatAnEventIsOver) {
  Alert restart{.key = "link.restarted:front-end", .message = "1 session"};
  terminal_.tell("SPINNER", "run", restart);
  EXPECT_EQ(said(), "info SPINNER: link.restarted:front-end: 1 session\n");
  restart.from = AlertState::Active;
  restart.state = AlertState::Cleared;
  terminal_.tell("SPINNER", "run", restart);
  EXPECT_EQ(said(), "");
}

TEST_F(Told, SaysASilenceAgainAfterOneMinuteAndFiveUntilItsEnd) {
  show_silence_of(100.0);
  EXPECT_EQ(said(), "");  // This silence raises no alert.
  silence_.severity = AlertSeverity::Critical;
  terminal_.tell("SPINNER", "run", silence_);
  said();
  show_silence_of(59.0);
  EXPECT_EQ(said(), "");
  show_silence_of(60.5);
  show_silence_of(61.5);
  EXPECT_EQ(said(), "critical SPINNER: link.silent: no telemetry for 1 min\n");
  show_silence_of(300.5);
  show_silence_of(9'000.0);
  EXPECT_EQ(said(), "critical SPINNER: link.silent: no telemetry for 5 min\n");
  tell(AlertState::Active, AlertState::Cleared);
  tell(std::nullopt, AlertState::Active);
  said();
  show_silence_of(61.0);
  EXPECT_EQ(said(), "critical SPINNER: link.silent: no telemetry for 1 min\n");
}

}  // namespace spindrift::service_terminal_test
