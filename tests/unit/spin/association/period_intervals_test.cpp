#include "pipelines/spin/association/period_intervals.h"

#include "pipelines/time/time_span.h"
#include "tests/support/matchers.h"

namespace spindrift::period_intervals_test {

using enum PulseChannel;

const TaiTime kStart = tai_from_ns(1'795'143'637'000'000'000);
constexpr double kPeriod_s = 0.8;

Revolution with_sun1(std::int64_t number, std::optional<Rejection> rejected_by = {}) {
  Revolution revolution{.number = number, .edges = {}, .period_candidate = {}, .period = {}};
  revolution.edges.at(index_of(Sun1)) = later_by_s(kStart, static_cast<double>(number) * kPeriod_s);
  revolution.edge_rejections.at(index_of(Sun1)) = rejected_by;
  return revolution;
}

class PeriodIntervalsTest : public ::testing::Test {
 protected:
  std::optional<PeriodCandidate> candidate(const Revolution& revolution,
                                           PulseChannel reference = Sun1) {
    return intervals_.candidate(revolution, reference, [](TaiTime) { return kPeriod_s; });
  }

  PeriodIntervals intervals_{SpinScreening{}, 1e-4};
};

TEST_F(PeriodIntervalsTest, AnIntervalMaySpanTurnsWithoutAnEdge) {
  EXPECT_FALSE(candidate(with_sun1(0)));
  const auto found = candidate(with_sun1(3)).value();
  EXPECT_FALSE(found.rejected_by);
  EXPECT_NEAR(found.period_s, kPeriod_s, 1e-9);
}

TEST_F(PeriodIntervalsTest, NoneStartsOrIsAcceptedAtABadEdge) {
  EXPECT_FALSE(candidate(with_sun1(0, Rejection::Phase)));
  EXPECT_FALSE(candidate(with_sun1(1)));
  const auto bad = candidate(with_sun1(2, Rejection::Phase)).value();
  EXPECT_EQ(bad.rejected_by, Rejection::Phase);
  EXPECT_FALSE(bad.said);
  ASSERT_TRUE(candidate(with_sun1(3)));
}

TEST_F(PeriodIntervalsTest, ANoteCountsWhereNoIntervalEnds) {
  constexpr double kNoted_s = 0.80005;
  for (int number = 0; number < 2; ++number) {
    intervals_.keep({.t_sun1 = *with_sun1(number).edge(Sun1), .period_s = kNoted_s});
  }
  const auto noted = candidate(with_sun1(0)).value();
  EXPECT_DOUBLE_EQ(noted.period_s, kNoted_s);
  const auto measured = candidate(with_sun1(1)).value();
  EXPECT_NEAR(measured.period_s, kPeriod_s, 1e-9);
}

TEST_F(PeriodIntervalsTest, OnlyTheLastSixteenNotesAreKept) {
  for (int number = 0; number < 20; ++number) {
    intervals_.keep({.t_sun1 = *with_sun1(number).edge(Sun1), .period_s = kPeriod_s});
  }
  ASSERT_EQ(intervals_.notes().size(), 16U);
  EXPECT_EQ(intervals_.notes().front().t_sun1, *with_sun1(4).edge(Sun1));
  intervals_.forget_notes_before(*with_sun1(18).edge(Sun1));
  EXPECT_EQ(intervals_.notes().size(), 2U);
}

TEST_F(PeriodIntervalsTest, NoIntervalSpansANewBeginning) {
  candidate(with_sun1(0));
  intervals_.begin_anew(1e-4);
  EXPECT_FALSE(candidate(with_sun1(1)));
  EXPECT_TRUE(candidate(with_sun1(2)));
}

TEST_F(PeriodIntervalsTest, WithoutAnEdgeOfTheReferenceThereIsNone) {
  candidate(with_sun1(0), Sun2);
  EXPECT_FALSE(candidate(with_sun1(1), Sun2));
}

}  // namespace spindrift::period_intervals_test
