#include "services/archive/detail_lane.h"

#include <chrono>
#include <string>
#include <vector>

#include "tests/support/matchers.h"

namespace spindrift::detail_lane_test {

using std::chrono::milliseconds;

const DetailLane::Instant kStart{};

ArchiveBatch batch_of(const std::string& run_id, std::size_t rows, const Product& product) {
  ArchiveBatch batch;
  batch.run_id = run_id;
  batch.products.assign(rows, product);
  return batch;
}

ArchiveBatch uses(const std::string& run_id, std::size_t rows) {
  return batch_of(run_id, rows, PulseUse{});
}

ArchiveBatch revolutions(const std::string& run_id, std::size_t rows) {
  return batch_of(run_id, rows, RevolutionProduct{});
}

std::vector<std::size_t> rows_of(const std::vector<ArchiveBatch>& batches) {
  std::vector<std::size_t> rows;
  for (const ArchiveBatch& batch : batches) {
    rows.push_back(row_count(batch));
  }
  return rows;
}

using Rows = std::vector<std::size_t>;

TEST(DetailLane, AFewWaitASecond) {
  DetailLane lane;
  EXPECT_FALSE(lane.next_due());
  lane.push(uses("A", 6), kStart);
  lane.push(uses("A", 5), kStart + milliseconds{600});
  EXPECT_EQ(lane.next_due(), kStart + milliseconds{1000});
  EXPECT_EQ(rows_of(lane.take_due(kStart + milliseconds{999}, 1000)), Rows{});
  EXPECT_EQ(lane.rows(), 11U);
  EXPECT_EQ(rows_of(lane.take_due(kStart + milliseconds{1000}, 1000)), (Rows{6, 5}));
  EXPECT_EQ(lane.rows(), 0U);
  EXPECT_EQ(lane.size(), 0U);
  EXPECT_FALSE(lane.next_due());
}

TEST(DetailLane, ManyOfATableAndRunWaitForNothing) {
  DetailLane lane;
  lane.push(uses("A", 63), kStart);
  lane.push(uses("B", 63), kStart);
  lane.push(revolutions("A", 63), kStart);
  EXPECT_EQ(rows_of(lane.take_due(kStart + milliseconds{1}, 1000)), Rows{});
  lane.push(revolutions("A", 1), kStart + milliseconds{1});
  const auto taken = lane.take_due(kStart + milliseconds{1}, 1000);
  ASSERT_EQ(rows_of(taken), (Rows{63, 1}));
  EXPECT_EQ(taken.front().run_id, "A");
  EXPECT_TRUE(std::holds_alternative<RevolutionProduct>(taken.front().products.front()));
}

TEST(DetailLane, WhoWaitedLongestIsFirst) {
  DetailLane lane;
  lane.push(uses("B", 64), kStart);
  lane.push(uses("A", 64), kStart + milliseconds{1});
  EXPECT_EQ(lane.take_due(kStart + milliseconds{2}, 1000).at(0).run_id, "B");
  EXPECT_EQ(lane.take_due(kStart + milliseconds{2}, 1000).at(0).run_id, "A");
}

TEST(DetailLane, TakesNoMoreThanIsAskedForAndAtLeastOne) {
  DetailLane lane;
  for (const std::size_t rows : {50U, 40U, 30U}) {
    lane.push(uses("A", rows), kStart);
  }
  EXPECT_EQ(rows_of(lane.take_due(kStart, 60)), (Rows{50, 40}));
  EXPECT_EQ(rows_of(lane.take_due(kStart + milliseconds{1000}, 1)), Rows{30});
}

TEST(DetailLane, AllOfARunAndNothingElse) {
  DetailLane lane;
  lane.push(uses("A", 3), kStart);
  lane.push(uses("AA", 4), kStart);
  lane.push(revolutions("A", 5), kStart);
  lane.push(uses("A", 6), kStart);
  EXPECT_EQ(rows_of(lane.take_all("A")), (Rows{3, 6, 5}));
  EXPECT_EQ(rows_of(lane.take_all("A")), Rows{});
  EXPECT_EQ(lane.rows(), 4U);
}

}  // namespace spindrift::detail_lane_test
