#include "pipelines/supervision/condition_watch.h"

#include "tests/support/matchers.h"

namespace spindrift::condition_watch_test {

TaiTime at(double t_s) { return shifted(tai_from_ns(1'795'143'637'000'000'000), t_s); }

ConditionWatch a_watch(Holding holding = {}) {
  return ConditionWatch{AlertCode::SpinSigma, "deg", holding};
}

TEST(ConditionWatch, RaisesAboveItsLimitAndClearsAtFourFifthsOfIt) {
  ConditionWatch watch = a_watch();
  EXPECT_FALSE(watch.update(at(0), {.value = 0.9, .limit = 1.0}));
  const auto raised = watch.update(at(1), {.value = 1.1, .limit = 1.0, .sigma = 0.2}).value();
  EXPECT_EQ(raised.change, Change::Raised);
  EXPECT_EQ(raised.t, at(1));
  EXPECT_EQ(raised.evidence.value, 1.1);
  EXPECT_EQ(raised.evidence.limit, 1.0);
  EXPECT_EQ(raised.evidence.sigma, 0.2);
  EXPECT_FALSE(watch.update(at(2), {.value = 1.2, .limit = 1.0}));
  EXPECT_FALSE(watch.update(at(3), {.value = 0.9, .limit = 1.0}));
  EXPECT_FALSE(watch.update(at(4), {.value = 1.1, .limit = 1.0}));
  const auto cleared = watch.update(at(5), {.value = 0.8, .limit = 1.0}).value();
  EXPECT_EQ(cleared.change, Change::Cleared);
}

TEST(ConditionWatch, RaisesWhatIsLessThanItShouldBe) {
  ConditionWatch watch{AlertCode::ArchiveDisk, "GiB"};
  EXPECT_FALSE(watch.see_least(at(0), {.value = 1.1, .limit = 1.0}));
  EXPECT_EQ(watch.see_least(at(1), {.value = 0.9, .limit = 1.0})->change, Change::Raised);
  EXPECT_FALSE(watch.see_least(at(2), {.value = 1.2, .limit = 1.0}));
  EXPECT_EQ(watch.see_least(at(3), {.value = 1.25, .limit = 1.0})->change, Change::Cleared);
}

TEST(ConditionWatch, RaisesAndClearsOnlyWhatIsHeldForSoLong) {
  ConditionWatch watch = a_watch({.raise_s = 10.0, .clear_s = 5.0});
  EXPECT_FALSE(watch.update(at(0), true));
  EXPECT_FALSE(watch.update(at(9), false));
  EXPECT_FALSE(watch.update(at(10), true));
  EXPECT_FALSE(watch.update(at(19), true));
  const auto raised = watch.update(at(21), true).value();
  EXPECT_EQ(raised.evidence.since, at(10));
  EXPECT_EQ(raised.evidence.value, 11.0);
  EXPECT_FALSE(watch.update(at(22), false));
  EXPECT_FALSE(watch.update(at(26), false));
  EXPECT_TRUE(watch.update(at(27), false));
}

TEST(ConditionWatch, GivesThePresenceOfAThingAsItsEvidence) {
  ConditionWatch watch{AlertCode::ServiceTwice, "services"};
  EXPECT_EQ(watch.update(at(0), false)->evidence.value, 0.0);
  const auto raised = watch.update(at(1), true).value();
  EXPECT_EQ(raised.evidence.value, 1.0);
  EXPECT_EQ(raised.evidence.limit, 1.0);
  EXPECT_EQ(raised.evidence.unit, "services");
  EXPECT_FALSE(watch.update(at(60), true));
}

TEST(ConditionWatch, RenewsWhatHasMovedByATenthAtMostEveryTenSeconds) {
  ConditionWatch watch = a_watch();
  const auto read = [&](double t_s, double value) {
    return watch.update(at(t_s), {.value = value, .limit = 1.0});
  };
  EXPECT_FALSE(read(-1, 0.9));
  ASSERT_EQ(read(0, 2.0)->change, Change::Raised);
  EXPECT_FALSE(read(5, 4.0));
  const auto renewed = read(10, 2.1).value();
  EXPECT_EQ(renewed.change, Change::Renewed);
  EXPECT_EQ(renewed.t, at(10));
  EXPECT_EQ(renewed.evidence.value, 2.1);
  EXPECT_EQ(renewed.evidence.worst, 4.0);
  EXPECT_EQ(renewed.evidence.since, at(0));
  EXPECT_FALSE(read(20, 2.3));
  EXPECT_EQ(read(21, 0.9)->evidence.value, 0.9);
  EXPECT_EQ(read(22, 0.8)->change, Change::Cleared);
  EXPECT_FALSE(read(40, 0.5));
  ASSERT_EQ(read(50, 1.0)->change, Change::Raised);
  EXPECT_EQ(read(60, 1.2)->evidence.worst, 1.2);
}

TEST(ConditionWatch, KnowsTheLeastAsTheWorstWhateverTheLimitBecomes) {
  ConditionWatch watch{AlertCode::ArchiveDisk, "GiB"};
  ASSERT_TRUE(watch.see_least(at(0), {.value = 0.9, .limit = 1.0}));
  EXPECT_FALSE(watch.see_least(at(1), {.value = 0.5, .limit = 0.7}));
  EXPECT_EQ(watch.see_least(at(10), {.value = 0.8, .limit = 1.0})->evidence.worst, 0.5);
}

TEST(ConditionWatch, RenewsForHowLongItHolds) {
  ConditionWatch watch = a_watch({.raise_s = 10.0, .clear_s = 5.0});
  EXPECT_FALSE(watch.update(at(0), true));
  ASSERT_TRUE(watch.update(at(10), true));
  EXPECT_FALSE(watch.update(at(12), false));
  EXPECT_EQ(watch.update(at(20), true)->evidence.value, 20.0);
  ConditionWatch present = a_watch();
  ASSERT_TRUE(present.update(at(0), true));
  EXPECT_FALSE(present.update(at(100), true));
}

TEST(ConditionWatch, SaysOnceWhatWasNotThereToBeginWith) {
  ConditionWatch watch = a_watch();
  const auto first = watch.update(at(0), false).value();
  EXPECT_EQ(first.change, Change::Cleared);
  EXPECT_FALSE(watch.update(at(1), false));
}

TEST(ConditionWatch, DoesNotLookAtWhatIsEarlier) {
  ConditionWatch watch = a_watch();
  ASSERT_TRUE(watch.update(at(1), false));
  EXPECT_FALSE(watch.update(at(0), true));
  const auto raised = watch.update(at(1), true).value();
  EXPECT_EQ(raised.change, Change::Raised);
  EXPECT_FALSE(watch.update(at(1), false));
  EXPECT_TRUE(watch.update(at(2), false));
}

}  // namespace spindrift::condition_watch_test
