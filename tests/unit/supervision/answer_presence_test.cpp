#include "pipelines/supervision/answer_presence.h"

#include <optional>
#include <string>

#include "tests/support/matchers.h"

namespace spindrift::answer_presence_test {

TaiTime at(double t_s) { return shifted(tai_from_ns(1'795'143'637'000'000'000), t_s); }

/// Gives a sample every second, the last at `to_s`. @return The last change.
std::optional<ConditionChange> give(AnswerPresence& presence, int from_s, int to_s) {
  std::optional<ConditionChange> last;
  for (int t_s = from_s; t_s <= to_s; ++t_s) {
    if (auto change = presence.see_sample(at(t_s))) {
      last = change;
    }
  }
  return last;
}

class AnswerPresenceTest : public ::testing::Test {
 protected:
  AnswerPresence presence_{AlertCode::SpinNoAnswer, 60.0};
};

TEST_F(AnswerPresenceTest, MissesAnAnswerAfterAMinuteOfSamples) {
  EXPECT_EQ(give(presence_, 0, 59)->change, Change::Cleared);
  const auto raised = give(presence_, 60, 60);
  ASSERT_TRUE(raised);
  EXPECT_EQ(raised->change, Change::Raised);
  EXPECT_EQ(raised->evidence.value, 60.0);
  EXPECT_EQ(raised->evidence.unit, "s");
  presence_.see_answer(at(70.0));
  EXPECT_FALSE(give(presence_, 61, 69));
  EXPECT_EQ(give(presence_, 70, 70)->change, Change::Cleared);
}

TEST_F(AnswerPresenceTest, MissesAnAnswerAgainWhenTheyStop) {
  presence_.see_answer(at(10.0));
  give(presence_, 0, 69);
  EXPECT_EQ(give(presence_, 70, 70)->change, Change::Raised);
}

TEST_F(AnswerPresenceTest, IsTheSameWhetherAnswersAreToldBeforeOrAfterTheirSamples) {
  AnswerPresence later{AlertCode::SpinNoAnswer, 60.0};
  std::optional<TaiTime> raised;
  std::optional<TaiTime> raised_later;
  const auto note = [](const std::optional<ConditionChange>& change, auto& place) {
    if (change && change->change == Change::Raised) {
      place = change->t;
    }
  };
  for (int t_s = 30; t_s < 300; t_s += 30) {
    presence_.see_answer(at(t_s));
  }
  for (int t_s = 0; t_s < 400; ++t_s) {
    note(presence_.see_sample(at(t_s)), raised);
    note(later.see_sample(at(t_s)), raised_later);
    if (t_s > 2 && t_s % 30 == 2 && t_s < 300) {
      later.see_answer(at(t_s - 2));
    }
  }
  EXPECT_EQ(raised, at(330.0));
  EXPECT_EQ(raised_later, at(333.0)) << "a sample after the answer was told the count begins anew";
}

TEST_F(AnswerPresenceTest, CountsNoSilenceAndNoDisorder) {
  EXPECT_TRUE(presence_.see_sample(at(0.0)));
  for (int t_s = 20; t_s < 2000; t_s += 20) {
    EXPECT_FALSE(presence_.see_sample(at(t_s))) << t_s;
    EXPECT_FALSE(presence_.see_sample(at(t_s - 15))) << t_s;
  }
}

}  // namespace spindrift::answer_presence_test
