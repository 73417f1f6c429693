#include "services/console/console_feed.h"

#include <chrono>
#include <memory>
#include <string>

#include "services/base/degrees.h"
#include "services/mission/mission.h"
#include "tests/support/matchers.h"
#include "tests/support/recorded_files.h"
#include "tests/support/some_health.h"

namespace spindrift::testing::console_feed_test {

using namespace std::chrono_literals;

// A time within the orbit of the recorded pass.
const TaiTime kT = tai_from_ns(1'795'143'700'000'000'000);

SpinEstimate estimate_at(TaiTime t, SpinEstimator estimator) {
  return {.t = t,
          .estimator = estimator,
          .axis_icrf = axis_icrf_from(100.0, -55.0),
          .covariance_rad2 = Eigen::Matrix2d::Identity() * 1e-6,
          .spin_rate_rad_s = 6.0,
          .spin_rate_sigma_rad_s = 1e-6,
          .assessment = {}};
}

class Feed : public ::testing::Test {
 protected:
  Feed() {
    missions_.back().target = SpinTarget{.axis_icrf = axis_icrf_from(100.0, -50.0)};
    feed_ = std::make_unique<ConsoleFeed>(missions_, nlohmann::json{{"name", "test"}});
  }
  nlohmann::json shown() { return feed_->state()["spacecraft"]["SPINNER"]; }
  template <class Told>
  void put(const Told& told, const std::string& run_id = "run") {
    feed_->put("SPINNER", run_id, told);
  }
  void put_details(std::vector<Product> products) {
    feed_->put_details({.run_id = "run", .spacecraft_id = "SPINNER", .products = products});
  }
  void put_link(LinkState link) {
    Health health = some_health();
    health.spacecraft = {
        {.spacecraft = "SPINNER", .link = link, .last_sample = kT, .data_age_s = 0.5}};
    feed_->put(health);
  }
  std::string events() const { return feed_->after(0).text; }

  std::vector<Mission> missions_{load_mission(kPasses / "nominal" / "mission.toml").value()};
  std::unique_ptr<ConsoleFeed> feed_;
};

TEST_F(Feed, SaysNothingGoodBeforeTelemetry) {
  const nlohmann::json state = shown();
  EXPECT_EQ(state["kind"], "spin");
  EXPECT_EQ(state["state"], "waiting");
  for (const char* const name : {"quality", "ra_deg", "utc", "data_age_s", "sun_ra_deg"}) {
    EXPECT_FALSE(state.contains(name)) << name;
  }
}

TEST_F(Feed, ShowsLinkSunAndEarthOfTheLastSample) {
  put_link(LinkState::Live);
  const nlohmann::json state = shown();
  EXPECT_EQ(state["state"], "live");
  EXPECT_EQ(state["t_tai_ns"], tai_ns(kT));
  EXPECT_EQ(state["data_age_s"], 0.5);
  EXPECT_TRUE(state["sun_ra_deg"].is_number()) << state;
  EXPECT_TRUE(state["earth_dec_deg"].is_number());
  EXPECT_EQ(feed_->state()["service"]["samples_received"], 6);
}

TEST_F(Feed, ShowsTheVerdictOfTheRunInForceAndHowFarTheTargetIs) {
  put(estimate_at(kT, SpinEstimator::Mean));
  put(PassVerdict{.quality = Quality::Lost}, "run of before");
  EXPECT_FALSE(shown().contains("quality"));
  put(PassVerdict{.quality = Quality::Ok, .ra_deg = 100.0, .dec_deg = -55.0, .against = "edges"});
  EXPECT_EQ(shown()["quality"], "OK");
  EXPECT_EQ(shown()["against"], "edges");
  EXPECT_FALSE(shown().contains("sigma_deg"));
  EXPECT_NEAR(shown()["to_target_deg"].get<double>(), 5.0, 1e-9);
  EXPECT_NEAR(shown()["target"]["dec_deg"].get<double>(), -50.0, 1e-9);
  EXPECT_EQ(shown()["estimates"]["mean"]["estimator"], "mean");
  put(estimate_at(kT, SpinEstimator::Mean), "next run");
  EXPECT_FALSE(shown().contains("quality"));
}

TEST_F(Feed, ShowsThePriorThatAnOperatorHasSetFromItsTimeOn) {
  put_link(LinkState::Live);
  put(estimate_at(kT, SpinEstimator::Mean));
  EXPECT_TRUE(shown()["prior"].is_null());
  const auto say = [&](TaiTime t, double ra_deg) {
    OperatorAction action{.action_id = "1",
                          .spacecraft = "SPINNER",
                          .t = t,
                          .made_utc = "",
                          .by = "shift",
                          .action = "set_prior",
                          .arguments = "{}",
                          .note = "",
                          .does = SpinAction{SetPrior{{.axis_icrf = axis_icrf_from(ra_deg, -50.0),
                                                       .sigma_rad = 2.0 * kRadPerDeg}}}};
    feed_->put_details({.run_id = "run", .spacecraft_id = "SPINNER", .actions = {action}});
  };
  say(kT + 1s, 30.0);
  EXPECT_TRUE(shown()["prior"].is_null());
  say(kT, 20.0);
  EXPECT_NEAR(shown()["prior"]["ra_deg"].get<double>(), 20.0, 1e-9);
  EXPECT_NEAR(shown()["prior"]["dec_deg"].get<double>(), -50.0, 1e-9);
  EXPECT_NEAR(shown()["prior"]["sigma_deg"].get<double>(), 2.0, 1e-9);
  put(estimate_at(kT, SpinEstimator::Mean), "next run");
  EXPECT_TRUE(shown()["prior"].is_null());
}

TEST_F(Feed, TellsTheOtherAxisThatSequentialFollows) {
  const auto put_open = [&](SpinEstimator estimator, double ra_deg) {
    SpinEstimate estimate = estimate_at(kT, estimator);
    estimate.assessment = {
        Quality::Ambiguous,
        {{ReasonCode::OtherAxis, {{"ra_deg", ra_deg}, {"dec_deg", -10.0}, {"sigma_deg", 2.0}}}}};
    put(estimate);
  };
  put_open(SpinEstimator::Sequential, 80.0);
  put_open(SpinEstimator::Batch, 70.0);
  EXPECT_EQ(shown()["other_axis"],
            (nlohmann::json{{"ra_deg", 80.0}, {"dec_deg", -10.0}, {"sigma_deg", 2.0}}));
  put(estimate_at(kT, SpinEstimator::Sequential));
  EXPECT_TRUE(shown()["other_axis"].is_null());
}

TEST_F(Feed, TellsTheBoundWithTheBatchSolution) {
  put(estimate_at(kT, SpinEstimator::Sequential));
  BatchSolution solution{};
  solution.estimate = estimate_at(kT, SpinEstimator::Batch);
  solution.bound_rad = 0.01 * kRadPerDeg;
  put_details({std::make_shared<const BatchSolution>(solution)});
  put(solution.estimate);
  EXPECT_NEAR(shown()["estimates"]["batch"]["bound_deg"].get<double>(), 0.01, 1e-12);
  EXPECT_FALSE(shown()["estimates"]["sequential"].contains("bound_deg"));
}

TEST_F(Feed, TellsEdgesTogetherWithTheirPhase) {
  put(estimate_at(kT, SpinEstimator::Mean));
  const auto edge = [](TaiTime t, std::optional<Rejection> rejected_by) {
    return PulseUse{.pulse = {.t = t, .channel = PulseChannel::Sun2},
                    .revolution = std::nullopt,
                    .rejected_by = rejected_by};
  };
  put_details({edge(kT - 1s, Rejection::Unassociated), edge(kT + 250ms, std::nullopt),
               RevolutionProduct{.revolution = 1, .t_sun1 = kT, .period_s = 1.0}});
  put_details({edge(kT + 3500ms, Rejection::Phase)});
  feed_->tell_pulses();
  feed_->tell_pulses();
  const std::string text = events();
  const auto data = text.find("event: pulse\ndata: ");
  ASSERT_NE(data, std::string::npos) << text;
  EXPECT_EQ(text.find("event: pulse", data + 1), std::string::npos);
  const auto told = nlohmann::json::parse(text.substr(text.find('{', data)));
  EXPECT_EQ(told["spacecraft"], "SPINNER");
  ASSERT_EQ(told["pulses"].size(), 3U);
  EXPECT_TRUE(told["pulses"][0]["phase_deg"].is_null());
  EXPECT_EQ(told["pulses"][0]["rejected_by"], "unassociated");
  EXPECT_EQ(told["pulses"][1]["phase_deg"], 90.0);
  EXPECT_EQ(told["pulses"][1]["accepted"], true);
  EXPECT_NEAR(told["pulses"][2]["phase_deg"].get<double>(), 180.0, 1e-6);
}

TEST_F(Feed, ShowsAlertsUntilTheyAreCleared) {
  Alert alert{.alert_id = "00ff",
              .key = "spin.sigma",
              .raised = kT,
              .message = "large",
              .evidence = R"({"value":2})"};
  feed_->put({.run_id = "run", .spacecraft = "SPINNER", .mode = RunMode::Live, .alert = alert});
  ASSERT_EQ(feed_->state()["alerts"].size(), 1U);
  EXPECT_EQ(feed_->state()["alerts"][0]["evidence"]["value"], 2);
  EXPECT_THAT(events(), Not(HasSubstr("event: alert")));
  alert.state = AlertState::Cleared;
  put(alert, "an older run");
  EXPECT_THAT(events(), HasSubstr("event: alert"));
  EXPECT_EQ(feed_->state()["alerts"].size(), 0U);
}

TEST_F(Feed, IsGoWhenNothingStandsAgainstIt) {
  put_link(LinkState::Live);
  put(estimate_at(kT, SpinEstimator::Mean));
  EXPECT_EQ(shown()["go"]["is_go"], false);
  put(PassVerdict{.quality = Quality::Ok, .sigma_deg = 0.1, .against = ""});
  EXPECT_EQ(shown()["go"], (nlohmann::json{{"is_go", true},
                                           {"against", nlohmann::json::array()},
                                           {"accepted", nlohmann::json::array()}}));
  put(Alert{.alert_id = "00ff",
            .key = "spin.nutation",
            .severity = AlertSeverity::Warning,
            .raised = kT,
            .message = "large",
            .evidence = "{}"});
  EXPECT_EQ(shown()["go"]["against"][0]["text"], "warning spin.nutation, active");
  feed_->put(failing_health());
  EXPECT_EQ(shown()["go"]["against"][0]["code"], "service");
}

TEST_F(Feed, HasNewsFromAChangeOfFixAnswerOrAlertUntilTheStateIsTold) {
  const auto is_news = [&](const auto& told) {
    feed_->tell_state();
    put(told);
    return feed_->has_news();
  };
  PassVerdict verdict{.quality = Quality::Ok, .t = kT, .against = ""};
  EXPECT_FALSE(is_news(estimate_at(kT, SpinEstimator::Mean)));
  EXPECT_TRUE(is_news(verdict));
  EXPECT_FALSE(is_news(verdict));
  verdict.t = kT + 1s;
  EXPECT_TRUE(is_news(verdict));
  EXPECT_TRUE(is_news(SpinFix{.t = kT, .axis_icrf = axis_icrf_from(100.0, -55.0)}));
  EXPECT_TRUE(is_news(Alert{.alert_id = "00ff", .raised = kT, .evidence = "{}"}));
}

TEST_F(Feed, TellsTheLastActionsOfTheRun) {
  std::vector<OperatorAction> actions;
  for (int i = 1; i <= 6; ++i) {
    actions.push_back({.action_id = std::to_string(i),
                       .spacecraft = "SPINNER",
                       .t = kT,
                       .made_utc = "2026-11-25T00:00:00.000Z",
                       .by = "night shift",
                       .action = "exclude_channel",
                       .arguments = R"({"channel":"sun2"})",
                       .note = "dead",
                       .does = {}});
  }
  put(estimate_at(kT, SpinEstimator::Mean));
  EXPECT_EQ(shown()["actions"].size(), 0U);
  feed_->put_details({.run_id = "run", .spacecraft_id = "SPINNER", .actions = actions});
  ASSERT_EQ(shown()["actions"].size(), 5U);
  const nlohmann::json last = shown()["actions"].back();
  EXPECT_EQ(last["action_id"], "6");
  EXPECT_EQ(last["arguments"]["channel"], "sun2");
  EXPECT_EQ(last["t_tai_ns"], tai_ns(kT));
  put(estimate_at(kT, SpinEstimator::Mean), "next run");
  EXPECT_EQ(shown()["actions"].size(), 0U);
}

TEST_F(Feed, TellsWhatAnActionHasDoneOnceTheRunSaysSo) {
  put(estimate_at(kT, SpinEstimator::Mean));
  const auto said = [](const std::string& id, const std::string& action) {
    return OperatorAction{.action_id = id,
                          .spacecraft = "SPINNER",
                          .t = kT,
                          .made_utc = {},
                          .by = "shift",
                          .action = action,
                          .arguments = "{}",
                          .note = {},
                          .does = {}};
  };
  feed_->put_details({.run_id = "run",
                      .spacecraft_id = "SPINNER",
                      .actions = {said("1", "exclude_segment"), said("2", "choose_root"),
                                  said("3", "set_limit"), said("4", "set_limit")}});
  EXPECT_FALSE(shown()["actions"][0].contains("effect"));
  put_details({RunNotice{.code = "batch_leaves_out",
                         .arguments = R"({"action":"exclude_segment","edges":412})",
                         .says = "batch leaves out 412 edges"},
               RunNotice{.code = "root_far_from_all", .arguments = "{}", .says = "no candidate"},
               RunNotice{.code = "limits_set", .arguments = R"({"action_id":"3"})", .says = "set"},
               RunNotice{.code = "late_edges", .arguments = "{}", .says = "late"}});
  EXPECT_EQ(shown()["actions"][0]["effect"], "batch leaves out 412 edges");
  EXPECT_EQ(shown()["actions"][1]["effect"], "no candidate");
  EXPECT_EQ(shown()["actions"][2]["effect"], "set");
  EXPECT_FALSE(shown()["actions"][3].contains("effect"));
  put_details({RunNotice{.code = "root_chosen", .arguments = "{}", .says = "taken"}});
  EXPECT_EQ(shown()["actions"][1]["effect"], "taken");
  for (const char* const code : {"prior_contradicted", "prior_far"}) {
    put_details({RunNotice{.code = code, .arguments = "{}", .says = code}});
    EXPECT_EQ(shown()["actions"][1]["effect"], code);
  }
}

TEST_F(Feed, TellsEveryExclusionThatIsInForce) {
  put(estimate_at(kT, SpinEstimator::Mean));
  const auto say = [&](const std::string& id, const SpinAction& does) {
    feed_->put_details({.run_id = "run",
                        .spacecraft_id = "SPINNER",
                        .actions = {{.action_id = id,
                                     .spacecraft = "SPINNER",
                                     .t = kT,
                                     .made_utc = {},
                                     .by = "shift",
                                     .action = {},
                                     .arguments = "{}",
                                     .note = {},
                                     .does = does}}});
  };
  const auto ids = [&] {
    std::string all;
    const nlohmann::json state = shown();
    for (const auto& action : state["actions"]) {
      all += action["action_id"].get<std::string>() + " ";
    }
    return all;
  };
  using enum PulseChannel;
  say("sun2", ExcludeChannel<PulseChannel>{Sun2});
  say("segment", ExcludeSegment<PulseChannel>{.from = kT, .to = kT, .channel = {}});
  say("north", ExcludeChannel<PulseChannel>{NorthIn});
  say("again", IncludeChannel<PulseChannel>{NorthIn});
  for (const char* const id : {"1", "2", "3", "4", "5"}) {
    say(id, MarkManoeuvre{});
  }
  EXPECT_EQ(ids(), "sun2 segment 1 2 3 4 5 ");
  for (const char* const id : {"a", "b", "c"}) {
    say(id, ExcludeSegment<PulseChannel>{.from = kT, .to = kT, .channel = {}});
  }
  say("6", MarkManoeuvre{});
  EXPECT_EQ(ids(), "sun2 segment 5 a b c 6 ") << "the newest is told whatever is in force";
}

TEST(FeedOfThreeAxes, ShowsAttitudeAndRate) {
  const std::vector<Mission> missions{
      load_mission(test_data() / "three-axis" / "separation" / "mission.toml").value()};
  ConsoleFeed feed{missions, {{"name", "test"}}};
  feed.put("LEOSAT", "run",
           AttitudeEstimate{.t = kT,
                            .q_icrf_body = {0.5, 0.5, -0.5, 0.5},
                            .rate_body_rad_s = Eigen::Vector3d{kRadPerDeg, 0.0, 0.0},
                            .covariance_rad2 = Eigen::Matrix3d::Identity() * 1e-6,
                            .assessment = {},
                            .source = AttitudeSource::Mekf});
  const auto shown = feed.state()["spacecraft"]["LEOSAT"];
  EXPECT_EQ(shown["kind"], "three_axis");
  EXPECT_EQ(shown["q_icrf_body"], (nlohmann::json{0.5, -0.5, 0.5, 0.5}));
  EXPECT_EQ(shown["rate_deg_s"][0], 1.0);
  EXPECT_FALSE(shown.contains("prior"));
  EXPECT_THAT(feed.after(0).text, HasSubstr("event: attitude\n"));
}

TEST_F(Feed, HasTroubleWhenTheServiceDoesNotWork) {
  EXPECT_EQ(feed_->trouble(), "");
  feed_->put(failing_health());
  EXPECT_EQ(feed_->trouble(), "not storing: disk full");
}

}  // namespace spindrift::testing::console_feed_test
