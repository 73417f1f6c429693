// `spindrift act`: through a running service, across a kill of the service, and without one.

#include <string>
#include <vector>

#include "tests/support/archive_rows.h"
#include "tests/support/matchers.h"
#include "tests/support/on_bus.h"
#include "tests/support/ran.h"
#include "tests/support/service.h"

namespace spindrift::act_test {

std::vector<std::string> act(const std::filesystem::path& db, std::vector<std::string> more) {
  more.insert(more.begin(), {"act", "--db", db, "--spacecraft", "SPINNER", "--by", "shift"});
  return more;
}

TEST(Act, GoesThroughTheServiceIntoTheArchiveAndIsRepeatedAfterAKill) {
  ReadyService service{"nominal"};
  FrontEnd front_end{service.bus(), "SPINNER", pulses_of("nominal")};
  ASSERT_TRUE(front_end.send_until(0.2));
  ASSERT_TRUE(eventually([&] { return count_rows(service.db(), "spin_estimate") > 50; }))
      << service.log();
  const Ran exclude = succeeded(act(
      service.db(), {"--action", "exclude_channel", "--channel", "north_in", "--note", "noisy"}));
  ASSERT_TRUE(eventually([&] { return count_rows(service.db(), "operator_action") == 1; }));
  EXPECT_THAT(
      rows_of(service.db(), "SELECT action_id, by, action, arguments, note FROM operator_action"),
      ElementsAre(exclude.out.substr(0, exclude.out.size() - 1) +
                  R"(|shift|exclude_channel|{"channel":"north_in"}|noisy|)"));
  EXPECT_THAT(service.program().log(), AllOf(HasSubstr("SPINNER: exclude_channel from "),
                                             HasSubstr("by shift"), HasSubstr("noisy")));
  ASSERT_TRUE(front_end.send_until(0.3));
  service.kill_and_go_on();
  ASSERT_TRUE(front_end.send_until(0.4));
  ASSERT_EQ(service.stop_when_computed(), 0) << service.log();

  EXPECT_EQ(count_rows(service.db(), "run"), 1);
  const auto rows = product_rows(service.db());
  service.go_on();
  ASSERT_EQ(service.stop_when_computed(), 0) << service.log();
  EXPECT_EQ(product_rows(service.db()), rows);
  EXPECT_EQ(
      count_rows(service.db(), "pulse_use WHERE rejected_by = 'operator' AND channel = 'north_in'"),
      count_rows(service.db(),
                 "pulse WHERE channel = 'north_in' AND t_tai_ns >= (SELECT t_tai_ns FROM "
                 "operator_action)"));
}

TEST(Act, SetsALimitOfAnAlertThatHoldsOverARestart) {
  ReadyService service{"nominal"};
  FrontEnd front_end{service.bus(), "SPINNER", pulses_of("nominal")};
  ASSERT_TRUE(front_end.send_until(0.2));
  ASSERT_TRUE(eventually([&] { return count_rows(service.db(), "spin_estimate") > 50; }))
      << service.log();
  EXPECT_EQ(count_rows(service.db(), "alert WHERE key = 'spin.sigma'"), 0);
  refused(act(service.db(), {"--action", "set_limit", "--key", "spin.sigma", "--gib", "1"}),
          {"gib is not known here: key, after_s, deg, hold_off_s are"});
  refused(
      act(service.db(), {"--action", "set_limit", "--key", "attitude.doubtful", "--seconds", "1"}),
      {"\"attitude.doubtful\": the mission of SPINNER has none: must be one of link.silent"});
  succeeded(act(service.db(), {"--action", "set_limit", "--key", "spin.sigma", "--deg", "0.0001",
                               "--after_s", "0"}));
  ASSERT_TRUE(front_end.send_until(0.3));
  const auto is_open = [&] {
    return count_rows(service.db(),
                      "alert WHERE key = 'spin.sigma' AND state = 'active' AND "
                      "evidence ->> 'limit' = 0.0001") == 1;
  };
  EXPECT_TRUE(eventually(is_open)) << service.log();
  EXPECT_THAT(service.log(), HasSubstr("spin.sigma is held to after_s 0, deg 0.0001"));
  service.kill_and_go_on();
  ASSERT_TRUE(front_end.send_until(0.4));
  ASSERT_EQ(service.stop_when_computed(), 0) << service.log();
  EXPECT_TRUE(is_open());
  EXPECT_THAT(rows_of(service.db(), "SELECT action, arguments FROM operator_action"),
              ElementsAre(R"(set_limit|{"after_s":0.0,"deg":0.0001,"key":"spin.sigma"}|)"));
  EXPECT_THAT(rows_of(service.db(), "SELECT count FROM alert WHERE key = 'spin.sigma'"),
              ElementsAre("1|"));
}

TEST(Act, SaysWhatIsWrongAndWhatToDo) {
  const TemporaryFolder folder;
  refused(act(folder.path() / "none.db", {"--action", "mark_manoeuvre"}), {"no service holds it"},
          1);
  ReadyService service{"nominal"};
  refused(act(service.db(), {"--action", "exclude_channel", "--channel", "north"}),
          {"channel: \"north\": must be one of sun1, sun2"});
  refused(act(service.db(), {"--action", "mark_manoeuvre", "--at", "noon"}), {"'noon'"});
}

}  // namespace spindrift::act_test
