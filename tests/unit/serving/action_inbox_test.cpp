#include "services/serving/action_inbox.h"

#include <fmt/format.h>

#include <chrono>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "services/archive/archive.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace spindrift::action_inbox_test {

constexpr std::size_t kMost = StoredActions::kMostAwaited;

std::string refusal_of(ActionInbox& inbox) {
  const auto taken = inbox.submit({{"spacecraft", "SPINNER"},
                                   {"by", "night shift"},
                                   {"action", "mark_manoeuvre"},
                                   {"t_tai_ns", 1'795'143'637'000'000'000}});
  return taken ? "" : taken.error().message;
}

class ActionInboxTest : public ::testing::Test {
 protected:
  TemporaryFolder folder_;
  std::unique_ptr<Archive> archive_ = Archive::open(folder_.path() / "pass.db", {}).value();
  BoundedQueue<SampleBatch> taken_{10};
  StoredActions stored_;
  ActionInbox inbox_{{{"SPINNER", SpacecraftKind::Spin}}, *archive_, taken_, stored_};
};

TEST_F(ActionInboxTest, RefusesMoreThanAreStored) {
  for (std::size_t i = 0; i < kMost; ++i) {
    ASSERT_TRUE(stored_.expect(fmt::format("action {}", i)));
  }
  EXPECT_THAT(refusal_of(inbox_), HasSubstr("64 actions wait to be stored already"));
  EXPECT_EQ(taken_.size(), 0U);
}

TEST_F(ActionInboxTest, OneThatIsNotTakenIsNotWaitedFor) {
  taken_.close();
  for (std::size_t i = 0; i <= kMost; ++i) {
    ASSERT_THAT(refusal_of(inbox_), HasSubstr("the service is stopping"));
  }
}

TEST(StoredActions, WaitForOneUntilItIsStored) {
  StoredActions stored;
  ASSERT_TRUE(stored.expect("action"));
  EXPECT_FALSE(stored.wait("action", std::chrono::seconds{0}));
  std::vector<ArchiveBatch> batches(1);
  batches.front().actions.emplace_back().action_id = "action";
  stored.confirm(batches);
  EXPECT_TRUE(stored.wait("action", std::chrono::seconds{0}));
}

}  // namespace spindrift::action_inbox_test
