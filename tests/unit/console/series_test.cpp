#include "services/console/series.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "tests/support/matchers.h"

namespace spindrift::series_test {

std::vector<SeriesPoint> flat(std::int64_t count) {
  std::vector<SeriesPoint> points;
  for (std::int64_t t = 0; t < count; ++t) {
    points.push_back({.t_tai_ns = t, .value = 1.0, .accepted = true});
  }
  return points;
}

TEST(Decimate, LeavesAsManyAsAreAskedForAsTheyAre) {
  const auto points = flat(10);
  EXPECT_EQ(decimate(points, 10), points);
  EXPECT_EQ(decimate(points, 10'000), points);
  EXPECT_THAT(decimate({}, 1), SizeIs(0));
}

TEST(Decimate, KeepsTheNewestAndTheExtremesInOrderOfTime) {
  auto points = flat(1000);
  points[333].value = 9.0;
  points[334].value = -9.0;
  for (const std::size_t most : {2U, 3U, 4U, 10U, 999U}) {
    const auto kept = decimate(points, most);
    EXPECT_LE(kept.size(), most);
    EXPECT_THAT(kept, Contains(points[333])) << most;
    EXPECT_THAT(kept, Contains(points[334])) << most;
    EXPECT_EQ(kept.back() == points.back(), most > 2) << most;
    EXPECT_TRUE(std::ranges::is_sorted(
        kept, [](const auto& a, const auto& b) { return a.t_tai_ns < b.t_tai_ns; }));
  }
  EXPECT_THAT(decimate(points, 1), ElementsAre(points[333]));
}

TEST(Decimate, ShowsWhatWasRejectedAmongWhatWasNot) {
  auto points = flat(1000);
  for (const std::size_t place : {100U, 500U}) {
    points[place].accepted = false;
    points[place].rejected_by = "late";
  }
  points[700].used = false;
  const auto kept = decimate(points, 20);
  EXPECT_LE(kept.size(), 20U);
  EXPECT_THAT(kept, Contains(points[100]));
  EXPECT_THAT(kept, Contains(points[500]));
  EXPECT_THAT(kept, Contains(points[700]));
}

TEST(Decimate, LeavesHalfToWhatWasAcceptedHoweverMuchWasRejected) {
  auto points = flat(1000);
  for (std::size_t i = 0; i < 900; ++i) {
    points[i].accepted = false;
  }
  const auto kept = decimate(points, 200);
  EXPECT_LE(kept.size(), 200U);
  EXPECT_EQ(std::ranges::count_if(kept, [](const SeriesPoint& point) { return *point.accepted; }),
            100);
}

}  // namespace spindrift::series_test
