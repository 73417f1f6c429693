#include "services/console/request_target.h"

#include "tests/support/matchers.h"

namespace spindrift::request_target_test {

TEST(RequestTarget, IsTakenApartAndDecoded) {
  const auto target =
      request_target("/api/v1/series?spacecraft=GMS%2D5+a&from=-12&empty=&flag").value();
  EXPECT_EQ(target.path, "/api/v1/series");
  EXPECT_EQ(target.text("spacecraft"), "GMS-5 a");
  EXPECT_EQ(target.text("empty"), "");
  EXPECT_EQ(target.text("flag"), "");
  EXPECT_EQ(target.integer("from", -100, 0), -12);
}

TEST(RequestTarget, SaysWhatIsWrongWithAParameter) {
  const auto target = request_target("/?points=0&to=1e9&from=99999999999999999999").value();
  EXPECT_THAT(target.integer("points", 1, 10'000).error().message,
              HasSubstr("points = 0: must be an integer from 1 to 10000"));
  EXPECT_FALSE(target.integer("to", 0, 10));
  EXPECT_FALSE(target.integer("from", 0, 10));
  EXPECT_THAT(target.text("spacecraft").error().message, HasSubstr("spacecraft: missing"));
}

TEST(RequestTarget, RefusesWhatHasTwoMeanings) {
  for (const char* const text : {"/%", "/%4", "/%zz", "/?a=%f", "/?%=1", "/?a=1&a=2"}) {
    EXPECT_FALSE(request_target(text)) << text;
  }
}

}  // namespace spindrift::request_target_test
