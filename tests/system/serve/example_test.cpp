#include <string>

#include "tests/support/matchers.h"
#include "tests/support/on_bus.h"

namespace spindrift::example_test {

TEST(Example, FollowsTheAnswersAndTheHealthOfAPass) {
  ReadyService service{"nominal"};
  const std::string loopback =
      "CYCLONEDDS_URI=file://" + (source_folder() / "deploy/cyclonedds/loopback.xml").string();
  Program follow{
      "/usr/bin/env",
      {loopback, example_program(), std::to_string(service.bus().domain), service.bus().partition}};
  const auto says = [&](const std::string& words) {
    return follow.out().find(words) != std::string::npos;
  };
  EXPECT_TRUE(eventually([&] { return says("verdict SPINNER waiting: no answer\n"); }))
      << follow.out() << follow.log();
  ASSERT_EQ(service.replay("0"), 0);
  EXPECT_TRUE(eventually([&] {
    return says("estimate SPINNER sequential t_tai_ns=") && says("health spindrift ") &&
           says(": OK by sequential, sigma_deg=0.0") && says(" against=\"\"\n");
  })) << follow.out()
      << follow.log();
  ASSERT_EQ(service.stop_when_computed(), 0);
  stop_in_order(follow);
  EXPECT_EQ(follow.log(), "");
}

TEST(Example, DoesNotStartWithoutANetworkConfiguration) {
  Program follow{"/usr/bin/env", {"-u", "CYCLONEDDS_URI", example_program(), "0", "live"}};
  EXPECT_EQ(follow.exit_status(), 2);
  EXPECT_THAT(follow.log(), HasSubstr("CYCLONEDDS_URI"));
}

}  // namespace spindrift::example_test
