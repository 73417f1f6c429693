#include "services/console/go_no_go.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace spindrift::go_no_go_test {
namespace {

const nlohmann::json kGood = {{"kind", "spin"},      {"state", "live"},       {"data_age_s", 0.4},
                              {"quality", "OK"},     {"why", "OK, 90 edges"}, {"sigma_deg", 0.1},
                              {"to_target_deg", 2.2}};

const nlohmann::json kNoChange = nlohmann::json::object();

/// "code: text" of what stands against it.
std::vector<std::string> against(const nlohmann::json& changes,
                                 const std::vector<nlohmann::json>& alerts = {},
                                 const std::string& trouble = "") {
  nlohmann::json shown = kGood;
  shown.merge_patch(changes);
  const nlohmann::json go = go_no_go(shown, alerts, trouble, AlertLimits{});
  std::vector<std::string> all;
  for (const nlohmann::json& one : go["against"]) {
    all.push_back(one["code"].get<std::string>() + ": " + one["text"].get<std::string>());
  }
  EXPECT_EQ(go["is_go"], all.empty());
  return all;
}

nlohmann::json alert(const char* key, const char* severity, const char* state) {
  return {{"key", key}, {"severity", severity}, {"state", state}};
}

using Reasons = std::vector<std::string>;

TEST(GoNoGo, IsGoWhenAllIsKnownAndNothingStandsAgainstIt) {
  EXPECT_EQ(against(kNoChange), Reasons{});
  EXPECT_EQ(against({{"to_target_deg", nullptr}}), Reasons{});
  EXPECT_EQ(against(kNoChange, {alert("link.restarted:S", "info", "active")}), Reasons{});
}

TEST(GoNoGo, IsNeverGoWhenItIsNotKnown) {
  const nlohmann::json nothing = go_no_go({{"kind", "spin"}}, {}, "", AlertLimits{});
  EXPECT_EQ(nothing["is_go"], false);
  EXPECT_EQ(nothing["against"].size(), 2U);
  EXPECT_EQ(against({{"state", "waiting"}}), Reasons{"link: no telemetry has come yet"});
  EXPECT_EQ(against({{"state", "stale"}, {"data_age_s", 12.3}}),
            Reasons{"link: no telemetry for 12 s"});
  EXPECT_EQ(against({{"quality", nullptr}}), Reasons{"quality: no answer yet"});
  EXPECT_EQ(against({{"sigma_deg", nullptr}}), Reasons{"quality: no answer yet"});
}

TEST(GoNoGo, SaysWhyTheAnswerIsNotToBeUsed) {
  EXPECT_EQ(against({{"quality", "AMBIGUOUS"}, {"against", "AMBIGUOUS, another axis fits"}}),
            Reasons{"quality: AMBIGUOUS, another axis fits"});
  EXPECT_EQ(against({{"quality", "DOUBTFUL"}, {"against", "mean and batch disagree"}}),
            Reasons{"quality: DOUBTFUL: mean and batch disagree"});
  EXPECT_EQ(against({{"against", "sequential and batch disagree"}}),
            Reasons{"quality: sequential and batch disagree"});
}

TEST(GoNoGo, HoldsAnAxisAgainstTheLimitsOfTheMission) {
  EXPECT_EQ(against({{"sigma_deg", 1.5}}), Reasons{"sigma: sigma 1.5 deg, limit 1"});
  EXPECT_EQ(against({{"to_target_deg", 2.4}}),
            Reasons{"target: 2.4 deg off the target, limit 2.3"});
  EXPECT_EQ(against({{"kind", "three_axis"}, {"sigma_deg", 1.5}}), Reasons{});
}

TEST(GoNoGo, NamesWhatIsOpenWhoeverHasSeenIt) {
  EXPECT_EQ(against(kNoChange, {alert("spin.nutation", "warning", "acknowledged"),
                                alert("attitude.lost", "critical", "shelved")}),
            (Reasons{"alert: warning spin.nutation, acknowledged",
                     "alert: critical attitude.lost, shelved"}));
}

TEST(GoNoGo, IsNotGoWhileTheServiceDoesNotWork) {
  EXPECT_EQ(against(kNoChange, {}, "not storing: disk full"),
            Reasons{"service: not storing: disk full"});
}

}  // namespace
}  // namespace spindrift::go_no_go_test
