#include <string>

#include "tests/integration/console/console_fixture.h"
#include "tests/support/matchers.h"
#include "tests/support/some_health.h"

namespace spindrift::console_answers_test {
namespace {

using ConsoleAnswers = ConsoleFixture;

const std::string kAck = "/api/v1/alerts/00ff00ff00ff00ff/ack";
const std::string kSeries = "/api/v1/series?spacecraft=SPINNER&quantity=sun_angle";

TEST_F(ConsoleAnswers, StateOfEverything) {
  const HttpReply reply = client_->get("/api/v1/state");
  EXPECT_EQ(reply.result_int(), 200U);
  EXPECT_EQ(reply["Content-Type"], "application/json");
  const auto state = nlohmann::json::parse(reply.body());
  EXPECT_EQ(state["spacecraft"]["SPINNER"]["state"], "waiting");
  EXPECT_EQ(state["alerts"][0]["alert_id"], kAlertId);
  EXPECT_EQ(state["alerts"][0]["spacecraft"], "SPINNER");
  EXPECT_EQ(state["service"]["version"], "0.1.0");
}

TEST_F(ConsoleAnswers, ThePageWithoutAddressesOfOthers) {
  const HttpReply page = client_->get("/");
  EXPECT_EQ(page.result_int(), 200U);
  EXPECT_EQ(page["Content-Type"], "text/html; charset=utf-8");
  EXPECT_EQ(client_->get("/index.html").body(), page.body());
  EXPECT_EQ(client_->get("/style.css")["Content-Type"], "text/css; charset=utf-8");
  const HttpReply script = client_->get("/app.js");
  EXPECT_EQ(script["Content-Type"], "text/javascript; charset=utf-8");
  for (const std::string& text : {page.body(), script.body()}) {
    EXPECT_THAT(text, Not(HasSubstr("://")));
  }
}

TEST_F(ConsoleAnswers, WithAPolicyThatAllowsNothingFromElsewhere) {
  for (const char* const target : {"/healthz", "/api/v1/state", "/nothing"}) {
    const HttpReply reply = client_->get(target);
    EXPECT_THAT(std::string{reply["Content-Security-Policy"]}, HasSubstr("default-src 'none'"));
    EXPECT_THAT(std::string{reply["Content-Security-Policy"]}, Not(HasSubstr("unsafe-inline")));
    EXPECT_EQ(reply.count("Access-Control-Allow-Origin"), 0U);
    EXPECT_EQ(reply["X-Content-Type-Options"], "nosniff");
  }
}

TEST_F(ConsoleAnswers, HealthWithTheReasonThatItFails) {
  EXPECT_EQ(client_->get_json("/healthz")["status"], "ok");
  feed_.put(testing::failing_health());
  const HttpReply reply = client_->get("/healthz");
  EXPECT_EQ(reply.result_int(), 503U);
  EXPECT_THAT(reply.body(), HasSubstr("disk full"));
}

TEST_F(ConsoleAnswers, ToItsOwnNamesOnly) {
  for (const char* const host : {"localhost", "LOCALHOST:1", "127.0.0.1:80", "ship:8080"}) {
    EXPECT_EQ(client_->get("/healthz", host).result_int(), 200U) << host;
  }
  for (const char* const host : {"evil.example", "localhost.evil.example", "", "[::1]"}) {
    EXPECT_EQ(client_->get("/healthz", host).result_int(), 400U) << host;
  }
  EXPECT_EQ(HttpClient::reply(client_->call("GET /healthz HTTP/1.0\r\n\r\n")).result_int(), 400U);
  EXPECT_EQ(HttpClient::reply(
                client_->call("GET /healthz HTTP/1.1\r\nHost: localhost\r\nHost: evil\r\n\r\n"))
                .result_int(),
            400U);
}

TEST_F(ConsoleAnswers, TellWhatIsNotThereFromWhatIsNotAllowed) {
  for (const char* const target :
       {"/nothing", "/../etc/passwd", "/%2e%2e/etc/passwd", "/api/v1/state/",
        "/api/v1/quantities?spacecraft=OTHER", "/api/v1/alerts/"}) {
    EXPECT_EQ(client_->get(target).result_int(), 404U) << target;
    EXPECT_TRUE(client_->get_json(target)["error"].is_string()) << target;
  }
  const HttpReply reply = client_->post("/api/v1/state", "", "");
  EXPECT_EQ(reply.result_int(), 405U);
  EXPECT_EQ(reply["Allow"], "GET");
  EXPECT_EQ(client_->get(kAck).result_int(), 405U);
}

TEST_F(ConsoleAnswers, ThatARequestIsNoHttp) {
  EXPECT_EQ(HttpClient::reply(client_->call("nonsense\r\n\r\n")).result_int(), 400U);
  EXPECT_EQ(client_->get("/" + std::string(20'000, 'a')).result_int(), 400U);
}

TEST_F(ConsoleAnswers, QuantitiesAndTheirSeries) {
  const auto quantities = client_->get_json("/api/v1/quantities?spacecraft=SPINNER")["quantities"];
  EXPECT_EQ(quantities[0], (nlohmann::json{{"name", "sun_angle"}, {"unit", "deg"}}));
  const auto points =
      client_->get_json(kSeries + "&from=49000000000&to=51000000000&points=10")["points"];
  ASSERT_EQ(points.size(), 3U) << points;
  EXPECT_EQ(points[0]["t_tai_ns"], 49'000'000'000);
  EXPECT_DOUBLE_EQ(points[0]["value"].get<double>(), 49.0 * kDegPerRad);
  EXPECT_EQ(points[0]["accepted"], true);
  EXPECT_FALSE(points[0].contains("rejected_by"));
  EXPECT_EQ(points[1]["accepted"], false);
  EXPECT_EQ(points[1]["rejected_by"], "sun_angle");
  const auto few = client_->get_json(kSeries + "&from=0&to=200000000000&points=6")["points"];
  EXPECT_LE(few.size(), 6U);
  EXPECT_EQ(few.front()["t_tai_ns"], 1'000'000'000);
  EXPECT_EQ(few.back()["t_tai_ns"], 100'000'000'000);
}

TEST_F(ConsoleAnswers, EveryQuantityThatIsListed) {
  const auto listed = client_->get_json("/api/v1/quantities?spacecraft=SPINNER")["quantities"];
  EXPECT_FALSE(listed.empty());
  for (const auto& one : listed) {
    const HttpReply reply =
        client_->get("/api/v1/series?spacecraft=SPINNER&from=0&to=9&points=5&quantity=" +
                     one["name"].get<std::string>());
    EXPECT_EQ(reply.result_int(), 200U) << one << reply.body();
  }
  for (const Quantity& one : quantities_of(SpacecraftKind::ThreeAxis)) {
    SQLite::Database database{path().string()};
    EXPECT_NO_THROW((SQLite::Statement{database, one.sql})) << one.name;
  }
}

TEST_F(ConsoleAnswers, WhatIsWrongWithASeries) {
  for (const char* const rest :
       {"", "&from=0&to=9", "&from=0&to=9&points=0", "&from=0&to=9&points=10001",
        "&from=9&to=0&points=5", "&from=a&to=9&points=5", "&from=0&to=9&points=5&from=1",
        "&from=0&to=9&points=%"}) {
    const HttpReply reply = client_->get(kSeries + rest);
    EXPECT_EQ(reply.result_int(), 400U) << rest;
    EXPECT_TRUE(nlohmann::json::parse(reply.body())["error"].is_string()) << rest;
  }
  EXPECT_EQ(
      client_
          ->get("/api/v1/"
                "series?spacecraft=SPINNER&quantity=value%20FROM%20run;--&from=0&to=9&points=5")
          .result_int(),
      400U);
  EXPECT_EQ(client_->get("/api/v1/quantities").result_int(), 400U);
}

TEST_F(ConsoleAnswers, AnAcknowledgementOnceItIsStoredAndTold) {
  EventViewer viewer = client_->watch();
  viewer.until("event: state");
  const HttpReply reply = client_->post(kAck, R"({"by":"night shift","note":"seen"})", token());
  ASSERT_EQ(reply.result_int(), 200U) << reply.body();
  EXPECT_EQ(nlohmann::json::parse(reply.body())["state"], "acknowledged");
  EXPECT_EQ(client_->get_json("/api/v1/state")["alerts"][0]["state"], "acknowledged");
  EXPECT_THAT(viewer.until("event: alert\n"), HasSubstr("id: "));
  EXPECT_THAT(texts("SELECT by || ':' || note || ':' || to_state FROM alert_transition "
                    "WHERE from_state IS NOT NULL"),
              ElementsAre("night shift:seen:acknowledged"));
  EXPECT_EQ(client_->post(kAck, R"({"by":"night shift"})", token()).result_int(),
            400U);  // The alert is already acknowledged.
}

TEST_F(ConsoleAnswers, NoNameOrNoteThatIsNoPlainTextAndNothingNestedDeep) {
  for (const std::string& body :
       {std::string{R"({"by":"a\nb"})"}, R"({"by":"a","note":")" + std::string(201, 'x') + "\"}",
        R"({"by":)" + std::string(8'000, '[') + "0" + std::string(8'000, ']') + "}"}) {
    const HttpReply reply = client_->post(kAck, body, token());
    EXPECT_EQ(reply.result_int(), 400U) << reply.body();
  }
  EXPECT_EQ(client_->get_json("/api/v1/state")["alerts"][0]["state"], "active");
}

/// What the state says for and against acting, with the ids of its alerts left out.
TEST_F(ConsoleAnswers, GoWithAWarningThatAnOperatorHasAcceptedAndWithNoneThatBearsOnTheAnswer) {
  Alert old_table = alert();
  old_table.alert_id = "11ff11ff11ff11ff";
  old_table.key = "data.outdated:leap_seconds";
  ArchiveBatch more = testing::batch_of(kRun);
  more.products.emplace_back(old_table);
  commit(*archive_, more);
  desk_.take_up("SPINNER", kRun, old_table);
  Health health = testing::some_health();
  health.spacecraft = {{.spacecraft = "SPINNER",
                        .link = LinkState::Live,
                        .last_sample = tai_from_ns(9),
                        .data_age_s = 0.1}};
  feed_.put(health);
  feed_.put("SPINNER", kRun, {.quality = Quality::Ok, .sigma_deg = 0.1, .against = ""});
  const auto go = [&] { return client_->get_json("/api/v1/state")["spacecraft"]["SPINNER"]["go"]; };
  EXPECT_EQ(go()["is_go"], false);
  EXPECT_EQ(go()["against"].size(), 2U);
  EXPECT_TRUE(go()["accepted"].empty());

  const std::string body = R"({"by":"OPS1","note":"known"})";
  ASSERT_EQ(client_->post("/api/v1/alerts/11ff11ff11ff11ff/ack", body, token()).result_int(), 200U);
  ASSERT_EQ(client_->post(kAck, body, token()).result_int(), 200U);
  EXPECT_EQ(go()["is_go"], false);
  ASSERT_EQ(go()["against"].size(), 1U);
  EXPECT_EQ(go()["against"][0]["text"], "warning spin.sigma, acknowledged");

  Alert over = alert();
  over.state = AlertState::Cleared;
  feed_.put({.run_id = kRun, .spacecraft = "SPINNER", .mode = RunMode::Live, .alert = over});
  EXPECT_EQ(go()["is_go"], true);
  ASSERT_EQ(go()["accepted"].size(), 1U);
  EXPECT_EQ(go()["accepted"][0]["key"], "data.outdated:leap_seconds");
  EXPECT_EQ(go()["accepted"][0]["by"], "OPS1");
  EXPECT_THAT(go()["accepted"][0]["text"].get<std::string>(),
              HasSubstr("the table of leap seconds is old, accepted by OPS1 "));
  EXPECT_EQ(texts("SELECT accepted_by FROM alert WHERE key = 'data.outdated:leap_seconds'"),
            std::vector<std::string>{"OPS1"});
}

TEST_F(ConsoleAnswers, ShelvingForAWhile) {
  const std::string target = "/api/v1/alerts/00ff00ff00ff00ff/shelve";
  EXPECT_EQ(client_->post(target, R"({"by":"a"})", token()).result_int(), 400U);
  const HttpReply reply = client_->post(target, R"({"by":"a","minutes":5})", token());
  ASSERT_EQ(reply.result_int(), 200U) << reply.body();
  EXPECT_EQ(nlohmann::json::parse(reply.body())["state"], "shelved");
}

TEST_F(ConsoleAnswers, NobodyWithoutTheToken) {
  const std::string body = R"({"by":"me"})";
  for (const std::string& wrong : {std::string{"wrong"}, std::string{}, token() + "0"}) {
    EXPECT_EQ(client_->post(kAck, body, wrong).result_int(), 401U);
  }
  const HttpReply reply = client_->post("/api/v1/alerts/0000/ack", "{}", "wrong");
  EXPECT_EQ(reply.result_int(), 401U);
  EXPECT_EQ(reply["WWW-Authenticate"], "Bearer");
  EXPECT_EQ(client_->post("/api/v1/alerts/0000/ack", body, token()).result_int(), 404U);
  EXPECT_EQ(client_->post(kAck, "by=me", token()).result_int(), 400U);
  EXPECT_EQ(client_->get_json("/api/v1/state")["alerts"][0]["state"], "active");
}

TEST_F(ConsoleAnswers, ALongBodyIsReadToItsEndAndRefusedBeforeTheTokenIsLookedAt) {
  const HttpReply reply = client_->post(kAck, std::string(40'000'000, 'x'), "wrong");
  EXPECT_EQ(reply.result_int(), 413U);
  EXPECT_TRUE(nlohmann::json::parse(reply.body())["error"].is_string());
  EXPECT_EQ(client_->post(kAck, std::string(16 * 1024, 'x'), "wrong").result_int(), 401U);
  EXPECT_EQ(client_->post(kAck, std::string(16 * 1024 + 1, 'x'), token()).result_int(), 413U);
}

TEST_F(ConsoleAnswers, MetricsForPrometheus) {
  const HttpReply reply = client_->get("/metrics");
  EXPECT_THAT(std::string{reply["Content-Type"]}, HasSubstr("text/plain; version=0.0.4"));
  EXPECT_THAT(reply.body(), HasSubstr("# TYPE spindrift_viewers gauge\nspindrift_viewers 0"));
  EXPECT_THAT(reply.body(), HasSubstr("spindrift_alert{spacecraft=\"SPINNER\",key=\"spin.sigma\","
                                      "severity=\"warning\",state=\"active\"} 1"));
  EXPECT_THAT(reply.body(), HasSubstr("spindrift_commit_seconds_bucket{le=\"+Inf\"}"));
  EXPECT_THAT(reply.body(), HasSubstr("spindrift_viewers_dropped_total 0"));
  EXPECT_THAT(reply.body(), HasSubstr("# TYPE spindrift_latency_seconds histogram\n"));
  EXPECT_THAT(reply.body(), HasSubstr("spindrift_latency_seconds_count 0\n"));
  feed_.note_latency(std::chrono::milliseconds{30});
  feed_.note_latency(std::chrono::seconds{20});
  const std::string later = client_->get("/metrics").body();
  EXPECT_THAT(later, HasSubstr("spindrift_latency_seconds_bucket{le=\"0.02\"} 0\n"));
  EXPECT_THAT(later, HasSubstr("spindrift_latency_seconds_bucket{le=\"0.05\"} 1\n"));
  EXPECT_THAT(later, HasSubstr("spindrift_latency_seconds_bucket{le=\"+Inf\"} 2\n"));
  EXPECT_THAT(later, HasSubstr("spindrift_latency_seconds_sum 20.03\n"));
}

TEST_F(ConsoleAnswers, TakesAnActionOfWhoeverHasTheToken) {
  const std::string kActions = "/api/v1/actions";
  const std::string action = R"({"spacecraft":"SPINNER","by":"me","action":"mark_manoeuvre"})";
  EXPECT_EQ(client_->get(kActions).result_int(), 405U);
  EXPECT_EQ(client_->post(kActions, action, "wrong").result_int(), 401U);
  EXPECT_EQ(client_->post(kActions, "[]", token()).result_int(), 400U);
  const HttpReply refused = client_->post(kActions, R"({"by":"me"})", token());
  EXPECT_EQ(refused.result_int(), 400U);
  EXPECT_THAT(refused.body(), HasSubstr("action: is missing"));
  EXPECT_TRUE(acts_.empty());
  const HttpReply taken = client_->post(kActions, action, token());
  EXPECT_EQ(taken.result_int(), 202U);
  EXPECT_EQ(nlohmann::json::parse(taken.body()), nlohmann::json({{"action_id", "act-1"}}));
  EXPECT_THAT(acts_, ElementsAre(nlohmann::json::parse(action)));
}

}  // namespace
}  // namespace spindrift::console_answers_test
