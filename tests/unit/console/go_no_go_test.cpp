#include "services/console/go_no_go.h"

#include <functional>
#include <string>
#include <vector>

#include "tests/support/matchers.h"

namespace spindrift::go_no_go_test {

using Change = std::function<void(Standing&)>;

Standing good() {
  return {.kind = SpacecraftKind::Spin,
          .link = LinkState::Live,
          .data_age_s = 0.4,
          .verdict = {.quality = Quality::Ok, .sigma_deg = 0.1, .against = ""},
          .to_target_deg = 2.2};
}

/// Returns "code: text" of each objection to a good standing after `change`, a line each.
std::string against(const Change& change, const std::string& trouble = "") {
  Standing standing = good();
  change(standing);
  std::string all;
  for (const Objection& objection : go_no_go(standing, trouble, AlertLimits{}).against) {
    all += std::string{objection.code} + ": " + objection.text + "\n";
  }
  return all;
}

Alert alert(const char* key, AlertSeverity severity, AlertState state) {
  return {.key = key, .severity = severity, .state = state};
}

struct Row {
  const char* when;
  Change change;
  std::string against;
};

TEST(GoNoGo, IsGoUnlessSomethingStandsAgainstIt) {
  const std::vector<Row> rows{
      {"all is known", [](auto& /*now*/) {}, ""},
      {"no target", [](auto& now) { now.to_target_deg.reset(); }, ""},
      {"an alert that informs",
       [](auto& now) {
         now.alerts = {alert("link.restarted:S", AlertSeverity::Info, AlertState::Active)};
       },
       ""},
      {"nothing has come", [](auto& now) { now.link = LinkState::Waiting; },
       "link: no telemetry has come yet\n"},
      {"nothing comes",
       [](auto& now) {
         now.link = LinkState::Stale;
         now.data_age_s = 12.3;
       },
       "link: no telemetry for 12 s\n"},
      {"no quality", [](auto& now) { now.verdict.quality.reset(); }, "quality: no answer yet\n"},
      {"no sigma", [](auto& now) { now.verdict.sigma_deg.reset(); }, "quality: no answer yet\n"},
      {"ambiguous",
       [](auto& now) {
         now.verdict.quality = Quality::Ambiguous;
         now.verdict.against = "AMBIGUOUS, another axis fits";
       },
       "quality: AMBIGUOUS, another axis fits\n"},
      {"doubtful",
       [](auto& now) {
         now.verdict.quality = Quality::Doubtful;
         now.verdict.against = "mean and batch disagree";
       },
       "quality: DOUBTFUL: mean and batch disagree\n"},
      {"disagreement", [](auto& now) { now.verdict.against = "sequential and batch disagree"; },
       "quality: sequential and batch disagree\n"},
      {"lost", [](auto& now) { now.verdict.quality = Quality::Lost; }, "quality: LOST\n"},
      {"wide sigma", [](auto& now) { now.verdict.sigma_deg = 1.5; },
       "sigma: sigma 1.5 deg, limit 1\n"},
      {"off the target", [](auto& now) { now.to_target_deg = 2.4; },
       "target: 2.4 deg off the target, limit 2.3\n"},
      {"wide sigma of three axes",
       [](auto& now) {
         now.kind = SpacecraftKind::ThreeAxis;
         now.verdict.sigma_deg = 1.5;
       },
       ""},
      {"alerts that somebody has seen",
       [](auto& now) {
         now.alerts = {alert("spin.nutation", AlertSeverity::Warning, AlertState::Acknowledged),
                       alert("attitude.lost", AlertSeverity::Critical, AlertState::Shelved)};
       },
       "alert: warning spin.nutation, acknowledged\nalert: critical attitude.lost, shelved\n"}};
  for (const Row& row : rows) {
    EXPECT_EQ(against(row.change), row.against) << row.when;
  }
  EXPECT_EQ(go_no_go({.kind = SpacecraftKind::Spin}, "", AlertLimits{}).against.size(), 2U);
}

/// Returns the decision on a good standing with an alert that OPS1 has acknowledged.
GoNoGo with_accepted(const char* key, AlertSeverity severity, AlertState state,
                     double to_target_deg = 0.0) {
  Standing standing = good();
  standing.to_target_deg = to_target_deg;
  standing.alerts = {alert(key, severity, state)};
  standing.alerts.front().accepted =
      Acknowledgement{.by = "OPS1", .t = tai_from_ns(1'795'144'357'000'000'000)};
  return go_no_go(standing, "", AlertLimits{});
}

TEST(GoNoGo, AcceptsAnAcknowledgedWarningThatDoesNotBearOnTheAnswer) {
  using enum AlertState;
  const GoNoGo go =
      with_accepted("data.outdated:leap_seconds", AlertSeverity::Warning, Acknowledged);
  EXPECT_THAT(go.against, IsEmpty());
  ASSERT_EQ(go.accepted.size(), 1U);
  EXPECT_EQ(go.accepted.front().key, "data.outdated:leap_seconds");
  EXPECT_EQ(go.accepted.front().accepted.by, "OPS1");
  EXPECT_EQ(go.accepted.front().text, "the table of leap seconds is old, accepted by OPS1 03:12");
  for (const auto state : {Active, Shelved}) {
    const GoNoGo not_yet =
        with_accepted("data.outdated:leap_seconds", AlertSeverity::Warning, state);
    EXPECT_EQ(not_yet.against.size(), 1U);
    EXPECT_THAT(not_yet.accepted, IsEmpty());
  }
}

TEST(GoNoGo, AcceptsAnAxisOffTheTargetAndMeasurementsThatAreLeftOut) {
  using enum AlertState;
  const auto off_target = [](AlertState state) {
    return with_accepted("spin.off_target", AlertSeverity::Warning, state, 2.4);
  };
  EXPECT_THAT(off_target(Acknowledged).against, IsEmpty());
  EXPECT_EQ(off_target(Acknowledged).accepted.size(), 1U);
  EXPECT_EQ(off_target(Active).against.size(), 2U);
  for (const char* const key : {"spin.rejection", "spin.period"}) {
    EXPECT_THAT(with_accepted(key, AlertSeverity::Warning, Acknowledged).against, IsEmpty());
  }
}

TEST(GoNoGo, IsNeverOverruledInWhatBearsOnTheAnswer) {
  for (const char* const key :
       {"spin.sigma", "spin.doubtful", "spin.ambiguous", "spin.disagree", "attitude.diverged",
        "link.late", "link.contradiction:gs1", "of.another.program"}) {
    EXPECT_EQ(with_accepted(key, AlertSeverity::Warning, AlertState::Acknowledged).against.size(),
              1U)
        << key;
  }
  EXPECT_EQ(with_accepted("archive.disk", AlertSeverity::Critical, AlertState::Acknowledged)
                .against.size(),
            1U);
}

TEST(GoNoGo, IsNotGoWhileTheServiceDoesNotWork) {
  EXPECT_EQ(against([](Standing&) {}, "not storing: disk full"),
            "service: not storing: disk full\n");
  EXPECT_EQ(against([](Standing& now) { now.link = LinkState::Stale; }, "not storing: disk full"),
            "service: not storing: disk full\n");
}

}  // namespace spindrift::go_no_go_test
