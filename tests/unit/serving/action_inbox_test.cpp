#include "services/serving/action_inbox.h"

#include <fmt/format.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
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
  ActionInbox inbox_{{{"SPINNER", Nameable{SpacecraftKind::Spin, {}, {}}}},
                     folder_.path() / "pass.db",
                     RunMode::Live,
                     *archive_,
                     taken_,
                     stored_};
};

TEST_F(ActionInboxTest, RefusesTimesOutsideThePassWithWhatIsAllowed) {
  constexpr std::int64_t kFirst_ns = 1'795'143'637'000'000'000;
  constexpr std::int64_t kDay_ns = 86'400'000'000'000;
  ArchiveBatch run{.run_id = "run", .spacecraft_id = "SPINNER"};
  run.start = RunStart{.spacecraft_kind = SpacecraftKind::Spin,
                       .mode = RunMode::Live,
                       .config_toml = "[spacecraft]",
                       .started_utc = "2026-11-20T03:00:00Z"};
  run.reach.emplace() = {.first = tai_from_ns(kFirst_ns), .last = tai_from_ns(kFirst_ns + 1)};
  ASSERT_TRUE(archive_->submit(run));
  ASSERT_TRUE(archive_->flush());
  taken_.close();
  const auto refusal = [&](const nlohmann::json& more) {
    nlohmann::json request{
        {"spacecraft", "SPINNER"}, {"by", "shift"}, {"action", "mark_manoeuvre"}};
    request.update(more);
    return inbox_.submit(request).error().message;
  };
  const std::string kTaken = "the service is stopping";
  EXPECT_THAT(refusal(nlohmann::json::object()), HasSubstr(kTaken));
  EXPECT_THAT(refusal({{"t_tai_ns", kFirst_ns}}), HasSubstr(kTaken));
  EXPECT_THAT(refusal({{"t_tai_ns", kFirst_ns - 1}}),
              AllOf(HasSubstr("mark_manoeuvre: 2026-11-20T02:59:59.999Z is outside the pass"),
                    HasSubstr("from its first sample, 2026-11-20T03:00:00.000Z, to ")));
  EXPECT_THAT(refusal({{"t_tai_ns", 4'000'000'000'000'000'000}}), HasSubstr("outside the pass"));
  const auto segment = [&](std::int64_t to_ns) {
    return refusal({{"action", "exclude_segment"},
                    {"from_tai_ns", kFirst_ns - kDay_ns},
                    {"to_tai_ns", to_ns}});
  };
  EXPECT_THAT(segment(kFirst_ns + 1), HasSubstr(kTaken));
  EXPECT_THAT(segment(kFirst_ns - 1), HasSubstr("outside the pass"));
}

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
