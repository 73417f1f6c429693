#include "services/console/go_no_go.h"

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

namespace spindrift::go_no_go_test {
namespace {

using Texts = std::vector<std::string>;
using Change = std::function<void(Standing&)>;

Standing good() {
  return {.kind = SpacecraftKind::Spin,
          .link = LinkState::Live,
          .data_age_s = 0.4,
          .verdict = {.quality = Quality::Ok, .sigma_deg = 0.1, .against = ""},
          .to_target_deg = 2.2};
}

/// Returns "code: text" of each objection to a good standing after `change`.
Texts against(const Change& change, const std::string& trouble = "") {
  Standing standing = good();
  change(standing);
  Texts all;
  for (const Objection& objection : go_no_go(standing, trouble, AlertLimits{})) {
    all.push_back(std::string{objection.code} + ": " + objection.text);
  }
  return all;
}

Alert alert(const char* key, AlertSeverity severity, AlertState state) {
  return {.key = key, .severity = severity, .state = state};
}

TEST(GoNoGo, IsGoWhenAllIsKnownAndNothingStandsAgainstIt) {
  EXPECT_EQ(against([](Standing&) {}), Texts{});
  EXPECT_EQ(against([](Standing& now) { now.to_target_deg.reset(); }), Texts{});
  EXPECT_EQ(against([](Standing& now) {
              now.alerts = {alert("link.restarted:S", AlertSeverity::Info, AlertState::Active)};
            }),
            Texts{});
}

TEST(GoNoGo, IsNeverGoWhenItIsNotKnown) {
  EXPECT_EQ(go_no_go({.kind = SpacecraftKind::Spin}, "", AlertLimits{}).size(), 2U);
  EXPECT_EQ(against([](Standing& now) { now.link = LinkState::Waiting; }),
            Texts{"link: no telemetry has come yet"});
  EXPECT_EQ(against([](Standing& now) {
              now.link = LinkState::Stale;
              now.data_age_s = 12.3;
            }),
            Texts{"link: no telemetry for 12 s"});
  EXPECT_EQ(against([](Standing& now) { now.verdict.quality.reset(); }),
            Texts{"quality: no answer yet"});
  EXPECT_EQ(against([](Standing& now) { now.verdict.sigma_deg.reset(); }),
            Texts{"quality: no answer yet"});
}

TEST(GoNoGo, SaysWhyTheAnswerIsNotToBeUsed) {
  EXPECT_EQ(against([](Standing& now) {
              now.verdict.quality = Quality::Ambiguous;
              now.verdict.against = "AMBIGUOUS, another axis fits";
            }),
            Texts{"quality: AMBIGUOUS, another axis fits"});
  EXPECT_EQ(against([](Standing& now) {
              now.verdict.quality = Quality::Doubtful;
              now.verdict.against = "mean and batch disagree";
            }),
            Texts{"quality: DOUBTFUL: mean and batch disagree"});
  EXPECT_EQ(against([](Standing& now) { now.verdict.against = "sequential and batch disagree"; }),
            Texts{"quality: sequential and batch disagree"});
  EXPECT_EQ(against([](Standing& now) { now.verdict.quality = Quality::Lost; }),
            Texts{"quality: LOST"});
}

TEST(GoNoGo, HoldsAnAxisAgainstTheLimitsOfTheMission) {
  EXPECT_EQ(against([](Standing& now) { now.verdict.sigma_deg = 1.5; }),
            Texts{"sigma: sigma 1.5 deg, limit 1"});
  EXPECT_EQ(against([](Standing& now) { now.to_target_deg = 2.4; }),
            Texts{"target: 2.4 deg off the target, limit 2.3"});
  EXPECT_EQ(against([](Standing& now) {
              now.kind = SpacecraftKind::ThreeAxis;
              now.verdict.sigma_deg = 1.5;
            }),
            Texts{});
}

TEST(GoNoGo, NamesWhatIsOpenWhoeverHasSeenIt) {
  EXPECT_EQ(against([](Standing& now) {
              now.alerts = {
                  alert("spin.nutation", AlertSeverity::Warning, AlertState::Acknowledged),
                  alert("attitude.lost", AlertSeverity::Critical, AlertState::Shelved)};
            }),
            (Texts{"alert: warning spin.nutation, acknowledged",
                   "alert: critical attitude.lost, shelved"}));
}

TEST(GoNoGo, IsNotGoWhileTheServiceDoesNotWork) {
  EXPECT_EQ(against([](Standing&) {}, "not storing: disk full"),
            Texts{"service: not storing: disk full"});
}

}  // namespace
}  // namespace spindrift::go_no_go_test
