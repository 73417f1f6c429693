#include "services/alerts/firing_alerts.h"

#include "tests/support/matchers.h"

namespace spindrift::firing_alerts_test {

using namespace std::chrono_literals;

constexpr TaiTime kRaised = tai_from_ns(1'795'143'637'000'000'000);  // 2026-11-20T03:00:00Z.

OpenAlert open_alert(std::int64_t revision = 1, AlertState state = AlertState::Active) {
  return {.spacecraft = "SPINNER",
          .alert = {.alert_id = "a1",
                    .key = "link.silent",
                    .severity = AlertSeverity::Critical,
                    .state = state,
                    .revision = revision,
                    .raised = kRaised,
                    .message = "SPINNER: no telemetry",
                    .evidence = R"({"value":6})"}};
}

/// Returns the alerts due for the state `open` at `after` since the raising, and marks them as
/// sent.
nlohmann::json told(FiringAlerts& firing, const std::vector<OpenAlert>& open,
                    std::chrono::seconds after) {
  nlohmann::json due = firing.due(open, kRaised + after);
  firing.told(kRaised + after);
  return due;
}

TEST(FiringAlerts, AreToldAsAlertmanagerWantsThem) {
  FiringAlerts firing{"spindrift host:1"};
  EXPECT_EQ(told(firing, {open_alert()}, 5s), nlohmann::json::parse(R"([{
              "labels": {"alertname": "link.silent", "spacecraft": "SPINNER", "severity": "critical",
                         "service": "spindrift host:1"},
              "annotations": {"summary": "SPINNER: no telemetry", "alert_id": "a1", "state": "active",
                              "evidence": "{\"value\":6}"},
              "startsAt": "2026-11-20T03:00:00.000Z", "endsAt": "2026-11-20T03:04:05.000Z"}])"));
}

TEST(FiringAlerts, AreToldAgainWhenTheyChangeAndEachMinute) {
  FiringAlerts firing{"s"};
  EXPECT_EQ(told(firing, {open_alert()}, 5s).size(), 1U);
  EXPECT_TRUE(told(firing, {open_alert()}, 64s).empty());
  EXPECT_EQ(told(firing, {open_alert()}, 65s).size(), 1U);
  EXPECT_EQ(told(firing, {open_alert(2, AlertState::Acknowledged)}, 66s).size(), 1U);
  EXPECT_TRUE(told(firing, {open_alert(2, AlertState::Acknowledged)}, 67s).empty());
}

TEST(FiringAlerts, EndOnceWhenTheyAreClearedOrShelved) {
  for (const auto& then :
       {std::vector<OpenAlert>{}, std::vector{open_alert(2, AlertState::Shelved)}}) {
    FiringAlerts firing{"s"};
    told(firing, {open_alert()}, 5s);
    const auto ended = told(firing, then, 8s);
    ASSERT_EQ(ended.size(), 1U);
    EXPECT_EQ(ended[0]["endsAt"], "2026-11-20T03:00:08.000Z");
    EXPECT_EQ(ended[0]["labels"]["alertname"], "link.silent");
    EXPECT_TRUE(told(firing, then, 9s).empty());
  }
}

TEST(FiringAlerts, StayDueUntilTheyAreTold) {
  FiringAlerts firing{"s"};
  EXPECT_EQ(firing.due(std::vector{open_alert()}, kRaised).size(), 1U);
  EXPECT_EQ(firing.due(std::vector{open_alert()}, kRaised + 1s).size(), 1U);
  firing.told(kRaised + 1s);
  EXPECT_EQ(firing.due({}, kRaised + 2s).size(), 1U);
  EXPECT_EQ(firing.due({}, kRaised + 3s).size(), 1U);
}

}  // namespace spindrift::firing_alerts_test
