#include "services/console/alert_request.h"

#include "tests/support/matchers.h"

namespace spindrift::alert_request_test {

TEST(AlertRequest, HasAPathOfItsOwn) {
  const auto ack = alert_path("/api/v1/alerts/00ff/ack");
  ASSERT_TRUE(ack);
  EXPECT_EQ(ack->alert_id, "00ff");
  EXPECT_FALSE(ack->shelves);
  EXPECT_TRUE(alert_path("/api/v1/alerts/00ff/shelve")->shelves);
  for (const char* const path : {"/api/v1/alerts//ack", "/api/v1/alerts/ack", "/api/v1/alerts/",
                                 "/api/v1/alerts/00ff/clear", "/api/v1/alerts/00ff", "/ack"}) {
    EXPECT_FALSE(alert_path(path)) << path;
  }
}

TEST(AlertRequest, TakesAnOperatorAtHisWord) {
  const auto word = operator_word({.alert_id = "00ff", .shelves = true},
                                  R"({"by":"night shift","note":"known","minutes":15})")
                        .value();
  EXPECT_EQ(word.alert_id, "00ff");
  EXPECT_EQ(word.by, "night shift");
  EXPECT_EQ(word.note, "known");
  EXPECT_EQ(word.minutes, 15);
  EXPECT_EQ(operator_word({.alert_id = "00ff", .shelves = false}, R"({"by":"a","minutes":15})")
                .value()
                .minutes,
            0);
}

TEST(AlertRequest, SaysWhatIsWrongWithABody) {
  const auto wrong = [](const char* body) {
    const auto word = operator_word({.alert_id = "00ff", .shelves = true}, body);
    return word ? "nothing" : word.error().message;
  };
  for (const char* const body : {"", "by=me", "[]", "{\"by\":\"\xff\"}"}) {
    EXPECT_THAT(wrong(body), HasSubstr("JSON object")) << body;
  }
  for (const char* const body : {"{}", R"({"by":7})"}) {
    EXPECT_THAT(wrong(body), HasSubstr("by:")) << body;
  }
  EXPECT_THAT(wrong(R"({"by":"a","note":1})"), HasSubstr("note:"));
  for (const char* const body :
       {R"({"by":"a"})", R"({"by":"a","minutes":0})", R"({"by":"a","minutes":10081})",
        R"({"by":"a","minutes":1.5})", R"({"by":"a","minutes":"5"})",
        R"({"by":"a","minutes":99999999999999999999})"}) {
    EXPECT_THAT(wrong(body), HasSubstr("minutes:")) << body;
  }
}

}  // namespace spindrift::alert_request_test
