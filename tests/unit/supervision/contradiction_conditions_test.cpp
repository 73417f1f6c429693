#include "pipelines/supervision/contradiction_conditions.h"

#include <vector>

#include "tests/support/matchers.h"

namespace spindrift::contradiction_conditions_test {

constexpr auto kOther = static_cast<Sender>(2);

TaiTime at_s(int t_s) { return tai_from_ns(1'795'143'637'000'000'000 + t_s * 1'000'000'000LL); }

SampleContradiction of(int t_s, std::vector<SampleContradiction::By> by) {
  return {.t = at_s(t_s), .kind = "star", .by = std::move(by)};
}
const std::vector<SampleContradiction::By> kBoth{{Sender::First, false, "A"}, {kOther, false, "B"}};

TEST(ContradictionConditions, AboutEachSourceAreRaisedOnceAndNameBoth) {
  ContradictionConditions conditions{AlertLimits{}};
  const ConditionChanges raised = conditions.evaluate(of(0, kBoth));
  ASSERT_THAT(raised, SizeIs(2));
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(raised[i].change, Change::Raised);
    EXPECT_EQ(raised[i].evidence.value, 1.0);
    EXPECT_EQ(raised[i].evidence.limit, 1.0);
    EXPECT_THAT(raised[i].evidence.sources, ElementsAre("A", "B"));
  }
  EXPECT_EQ(alert_key(raised[0].code, raised[0].about), "link.contradiction:A");
  EXPECT_EQ(raised[0].who, "B");
  EXPECT_EQ(alert_key(raised[1].code, raised[1].about), "link.contradiction:B");
  EXPECT_EQ(severity_of(raised[1].code), AlertSeverity::Warning);
  EXPECT_THAT(conditions.evaluate(of(1, kBoth)), IsEmpty());
}

TEST(ContradictionConditions, EndAMinuteBehindTheLast) {
  ContradictionConditions conditions{AlertLimits{}};
  conditions.evaluate(of(0, kBoth));
  conditions.evaluate(of(10, kBoth));
  const ConditionChanges fewer = conditions.evaluate(at_s(69));
  ASSERT_THAT(fewer, SizeIs(2));
  EXPECT_EQ(fewer.front().change, Change::Renewed);
  EXPECT_THAT(fewer.front().evidence.sources, ElementsAre("A", "B"));
  const ConditionChanges over = conditions.evaluate(at_s(70));
  ASSERT_THAT(over, SizeIs(2));
  EXPECT_EQ(over.front().change, Change::Cleared);
}

TEST(ContradictionConditions, ThePreferredSourceIsNotDoubtedUnlessByItself) {
  ContradictionConditions conditions{AlertLimits{}};
  const ConditionChanges raised =
      conditions.evaluate(of(0, {{Sender::Preferred, true, "A"}, {kOther, false, "B"}}));
  ASSERT_THAT(raised, SizeIs(1));
  EXPECT_EQ(raised.front().about, "B");
  EXPECT_EQ(raised.front().who, "A");
  ASSERT_THAT(conditions.evaluate(of(1, {{Sender::Preferred, false, "A"}})), SizeIs(1));
}

TEST(ContradictionConditions, TakeSoManyInAMinuteAsTheLimitSays) {
  AlertLimits limits;
  limits.contradicted_samples = 3.0;
  ContradictionConditions conditions{limits};
  const auto raises = [&](int t_s) {
    const ConditionChanges changes = conditions.evaluate(of(t_s, kBoth));
    return !changes.empty() && changes.front().change == Change::Raised;
  };
  EXPECT_FALSE(raises(0));
  EXPECT_FALSE(raises(59));
  EXPECT_FALSE(raises(61));
  EXPECT_TRUE(raises(62));
}

}  // namespace spindrift::contradiction_conditions_test
