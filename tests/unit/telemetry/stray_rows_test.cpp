#include "services/telemetry/stray_rows.h"

#include <algorithm>
#include <random>
#include <vector>

#include "tests/support/matchers.h"

namespace spindrift::stray_rows_test {

constexpr std::int64_t kStart_s = 1'795'143'637;

std::vector<TaiTime> times_of(const std::vector<double>& seconds) {
  std::vector<TaiTime> times;
  for (const double second : seconds) {
    times.push_back(
        tai_from_ns(kStart_s * 1'000'000'000 + static_cast<std::int64_t>(second * 1e9)));
  }
  return times;
}

std::vector<std::size_t> stray(const std::vector<double>& seconds) {
  std::vector<std::size_t> rows;
  for (const StrayRow& found : find_stray_rows(times_of(seconds))) {
    rows.push_back(found.row);
  }
  return rows;
}

/// Returns `count` times a second apart from `from_s` on.
std::vector<double> run(double from_s, int count) {
  std::vector<double> seconds;
  for (int i = 0; i < count; ++i) {
    seconds.push_back(from_s + i);
  }
  return seconds;
}

std::vector<double> joined(std::initializer_list<std::vector<double>> parts) {
  std::vector<double> all;
  for (const std::vector<double>& part : parts) {
    all.insert(all.end(), part.begin(), part.end());
  }
  return all;
}

TEST(StrayRows, StandBetweenTwoThatGoOnFromOneAnother) {
  EXPECT_EQ(stray(joined({run(0, 20), run(1800, 5), run(20, 20)})),
            (std::vector<std::size_t>{20, 21, 22, 23, 24}));
  EXPECT_EQ(stray(joined({run(0, 20), {-1800.0, 9000.0}, run(20, 20)})),
            (std::vector<std::size_t>{20, 21}));
  const auto found = find_stray_rows(times_of(joined({run(0, 3), {1800.0}, run(3, 3)})));
  EXPECT_THAT(found, ElementsAre(Field(&StrayRow::after, 2U)));
}

TEST(StrayRows, AreNoneBehindASilenceNorInABlockInTheWrongPlace) {
  EXPECT_TRUE(stray(joined({run(0, 50), run(1800, 5)})).empty());
  EXPECT_TRUE(stray(joined({run(1800, 5), run(0, 50)})).empty());
  EXPECT_TRUE(stray(joined({run(0, 50), run(1800, 50), run(60, 5)})).empty());
  EXPECT_TRUE(stray({}).empty());
}

TEST(StrayRows, AreNoneWhereNoRowStandsInOrder) {
  std::vector<double> seconds = run(0, 600);
  std::ranges::shuffle(seconds, std::mt19937_64{51});
  EXPECT_TRUE(stray(seconds).empty());
}

TEST(StrayRows, AreFoundAmongDisorderWithinASecond) {
  std::mt19937_64 rng{52};
  std::vector<double> seconds;
  for (int i = 0; i < 6000; ++i) {
    seconds.push_back(0.1 * i);
  }
  for (std::size_t i = 0; i < seconds.size(); i += 10) {
    std::shuffle(seconds.begin() + static_cast<std::ptrdiff_t>(i),
                 seconds.begin() + static_cast<std::ptrdiff_t>(i + 10), rng);
  }
  seconds.insert(seconds.begin() + 3000, 3600.0);
  EXPECT_EQ(stray(seconds), (std::vector<std::size_t>{3000}));
}

}  // namespace spindrift::stray_rows_test
