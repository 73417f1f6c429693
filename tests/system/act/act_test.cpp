// `spindrift act`: through a running service, across a kill of the service, and without one.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <string>
#include <vector>

#include "tests/support/archive_rows.h"
#include "tests/support/service.h"

namespace spindrift::act_test {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::vector<std::string> act(const std::filesystem::path& db, std::vector<std::string> more) {
  more.insert(more.begin(),
              {"act", "--db", db.string(), "--spacecraft", "SPINNER", "--by", "shift"});
  return more;
}

TEST(Act, GoesThroughTheServiceIntoTheArchiveAndIsRepeatedAfterAKill) {
  Service service{"nominal"};
  FrontEnd front_end{service.bus(), "SPINNER", pulses_of("nominal")};
  ASSERT_TRUE(service.ready()) << service.program().log();
  ASSERT_TRUE(front_end.send_until(0.2));
  ASSERT_TRUE(eventually([&] {
    return number_of(service.db(), "SELECT count(*) FROM spin_estimate") > 50;
  })) << service.program().log();
  Program exclude{act(service.db(),
                      {"--action", "exclude_channel", "--channel", "north_in", "--note", "noisy"})};
  ASSERT_EQ(exclude.exit_status(), 0) << exclude.log();
  ASSERT_TRUE(eventually(
      [&] { return number_of(service.db(), "SELECT count(*) FROM operator_action") == 1; }));
  EXPECT_EQ(rows_of(service.db(),
                    "SELECT action_id, by, action, arguments, note FROM"
                    " operator_action"),
            std::vector<std::string>{exclude.out().substr(0, exclude.out().size() - 1) +
                                     R"(|shift|exclude_channel|{"channel":"north_in"}|noisy|)"});
  EXPECT_THAT(service.program().log(), AllOf(HasSubstr("SPINNER: exclude_channel from "),
                                             HasSubstr("by shift"), HasSubstr("noisy")));
  ASSERT_TRUE(front_end.send_until(0.3));
  service.program().signal(SIGKILL);
  ASSERT_EQ(service.program().exit_status(), -1);
  service.start();
  ASSERT_TRUE(service.ready()) << service.program().log();
  ASSERT_TRUE(front_end.send_until(0.4));
  ASSERT_EQ(service.stop_when_computed(), 0) << service.program().log();

  EXPECT_EQ(number_of(service.db(), "SELECT count(*) FROM run"), 1);
  const auto rows = product_rows(service.db());
  service.start();
  ASSERT_TRUE(service.ready()) << service.program().log();
  ASSERT_EQ(service.stop_when_computed(), 0) << service.program().log();
  EXPECT_EQ(product_rows(service.db()), rows);
  EXPECT_EQ(number_of(service.db(),
                      "SELECT count(*) FROM pulse_use WHERE rejected_by = 'operator' AND"
                      " channel = 'north_in'"),
            number_of(service.db(),
                      "SELECT count(*) FROM pulse WHERE channel = 'north_in' AND t_tai_ns >="
                      " (SELECT t_tai_ns FROM operator_action)"));
}

TEST(Act, SaysWhatIsWrongAndWhatToDo) {
  const TemporaryFolder folder;
  Program nobody{act(folder.path() / "none.db", {"--action", "mark_manoeuvre"})};
  EXPECT_EQ(nobody.exit_status(), 1);
  EXPECT_THAT(nobody.log(), HasSubstr("no service holds it"));
  Service service{"nominal"};
  ASSERT_TRUE(service.ready()) << service.program().log();
  Program wrong{act(service.db(), {"--action", "exclude_channel", "--channel", "north"})};
  EXPECT_EQ(wrong.exit_status(), 2);
  EXPECT_THAT(wrong.log(), HasSubstr("channel: \"north\": must be one of sun1, sun2"));
  Program time{act(service.db(), {"--action", "mark_manoeuvre", "--at", "noon"})};
  EXPECT_EQ(time.exit_status(), 2);
  EXPECT_THAT(time.log(), HasSubstr("'noon'"));
}

}  // namespace spindrift::act_test
