#include "services/archive/batch_queue.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <thread>
#include <vector>

namespace spindrift::batch_queue_test {

using ::testing::ElementsAre;

ArchiveBatch batch_of(const std::string& run_id) {
  ArchiveBatch batch;
  batch.run_id = run_id;
  return batch;
}

ArchiveBatch samples(std::size_t count) {
  ArchiveBatch batch = batch_of("samples");
  batch.samples.of<Pulse>().resize(count);
  return batch;
}

ArchiveBatch results(std::size_t count, const std::string& run_id = "results") {
  ArchiveBatch batch = batch_of(run_id);
  batch.products.assign(count, SpinEstimate{.t = {},
                                            .estimator = SpinEstimator::Mean,
                                            .axis_icrf = Eigen::Vector3d::UnitZ(),
                                            .covariance_rad2 = Eigen::Matrix2d::Identity(),
                                            .spin_rate_rad_s = 1.0,
                                            .spin_rate_sigma_rad_s = 1.0,
                                            .assessment = {}});
  return batch;
}

ArchiveBatch details(std::size_t count, const std::string& run_id = "details") {
  ArchiveBatch batch = batch_of(run_id);
  batch.products.assign(count, PulseUse{});
  return batch;
}

std::vector<std::string> names_of(const std::vector<ArchiveBatch>& batches) {
  std::vector<std::string> names;
  for (const ArchiveBatch& batch : batches) {
    names.push_back(batch.run_id);
  }
  return names;
}

TEST(BatchQueue, GivesSamplesFirstAndAllWhenThereAreFew) {
  BatchQueue queue{1000};
  ASSERT_TRUE(queue.push(results(10)));
  ASSERT_TRUE(queue.push(samples(10)));
  ASSERT_TRUE(queue.push(results(10)));
  EXPECT_THAT(names_of(queue.take()), ElementsAre("samples", "results", "results"));
}

TEST(BatchQueue, BeginsARunBeforeItsSamplesWhateverIsToldWithIt) {
  BatchQueue queue{1000};
  ArchiveBatch first = batch_of("first");
  first.start.emplace();
  first.products.emplace_back(RunNotice{});
  ASSERT_TRUE(queue.push(std::move(first)));
  ASSERT_TRUE(queue.push(samples(10)));
  EXPECT_THAT(names_of(queue.take()), ElementsAre("first", "samples"));
}

TEST(BatchQueue, LetsProductsWaitInABurstOfSamplesButNotForEver) {
  BatchQueue queue{100'000};
  ASSERT_TRUE(queue.push(results(500)));
  ASSERT_TRUE(queue.push(results(500)));
  ASSERT_TRUE(queue.push(samples(3200)));
  EXPECT_THAT(names_of(queue.take()), ElementsAre("samples", "results"));
  ASSERT_TRUE(queue.push(samples(800)));
  EXPECT_THAT(names_of(queue.take()), ElementsAre("samples"));
  ASSERT_TRUE(queue.push(samples(800)));
  EXPECT_THAT(names_of(queue.take()), ElementsAre("samples", "results"));
}

TEST(BatchQueue, ForgetsWhatABurstOwesOnceItIsOver) {
  BatchQueue queue{100'000};
  ASSERT_TRUE(queue.push(results(50'000)));
  ASSERT_TRUE(queue.push(results(10)));
  ASSERT_TRUE(queue.push(samples(200)));
  EXPECT_THAT(names_of(queue.take()), ElementsAre("samples", "results"));
  EXPECT_THAT(names_of(queue.take()), ElementsAre("results"));
}

TEST(BatchQueue, LetsDetailsWaitForACommitWithoutResults) {
  BatchQueue queue{100'000};
  ASSERT_TRUE(queue.push(details(100)));
  ASSERT_TRUE(queue.push(results(1)));
  ASSERT_TRUE(queue.push(samples(1)));
  EXPECT_THAT(names_of(queue.take()), ElementsAre("samples", "results"));
  EXPECT_EQ(queue.size(), 1U);
  EXPECT_THAT(names_of(queue.take()), ElementsAre("details"));
}

TEST(BatchQueue, TakesManyDetailsAlongWithResults) {
  BatchQueue queue{100'000};
  ASSERT_TRUE(queue.push(details(9000)));
  ASSERT_TRUE(queue.push(results(1)));
  EXPECT_THAT(names_of(queue.take()), ElementsAre("results", "details"));
}

TEST(BatchQueue, GivesAFewDetailsLate) {
  using std::chrono::steady_clock;
  BatchQueue queue{100'000};
  const auto start = steady_clock::now();
  ASSERT_TRUE(queue.push(details(1)));
  ASSERT_TRUE(queue.push(details(1)));
  EXPECT_THAT(names_of(queue.take()), ElementsAre("details", "details"));
  EXPECT_GE(steady_clock::now() - start, std::chrono::seconds{1});
}

// Details are due after a second, which a busy machine may need to push the samples; the test is
// then repeated.
TEST(BatchQueue, GivesAFewSamplesAtOnceThoughDetailsWait) {
  using std::chrono::steady_clock;
  for (int tries = 0; tries < 20; ++tries) {
    BatchQueue queue{100'000};
    const auto start = steady_clock::now();
    ASSERT_TRUE(queue.push(details(1)));
    std::vector<ArchiveBatch> taken;
    std::thread writer{[&] { taken = queue.take(); }};
    // Let the writer wait for the details.
    std::this_thread::sleep_for(std::chrono::milliseconds{50});
    ASSERT_TRUE(queue.push(samples(1)));
    writer.join();
    if (steady_clock::now() - start < std::chrono::milliseconds{900}) {
      EXPECT_THAT(names_of(taken), ElementsAre("samples"));
      EXPECT_EQ(queue.size(), 1U);
      return;
    }
  }
  GTEST_SKIP() << "the machine is too busy to be in time";
}

TEST(BatchQueue, EndsARunAfterItsDetails) {
  BatchQueue queue{100'000};
  ArchiveBatch end = batch_of("A");
  end.finished_utc = "2026-11-20T04:00:00Z";
  ASSERT_TRUE(queue.push(details(3, "B")));
  ASSERT_TRUE(queue.push(details(3, "A")));
  ASSERT_TRUE(queue.push(std::move(end)));
  const auto taken = queue.take();
  EXPECT_THAT(names_of(taken), ElementsAre("A", "A"));
  EXPECT_TRUE(taken.back().finished_utc);
}

TEST(BatchQueue, WithdrawsDetailsFromBeforeAndNotThoseMadeAgain) {
  BatchQueue queue{100'000};
  ArchiveBatch again = results(1, "A");
  again.continuation = Continuation{.t = TaiTime::min()};
  ASSERT_TRUE(queue.push(details(3, "A")));
  ASSERT_TRUE(queue.push(std::move(again)));
  ASSERT_TRUE(queue.push(details(100, "A")));
  const auto taken = queue.take();
  ASSERT_THAT(names_of(taken), ElementsAre("A", "A"));
  EXPECT_TRUE(taken.back().continuation);
  EXPECT_EQ(row_count(queue.take().at(0)), 100U);
}

TEST(BatchQueue, HasOneBoundForResultsAndDetails) {
  BatchQueue queue{20};
  ASSERT_TRUE(queue.push(details(10)));
  ASSERT_TRUE(queue.push(results(10)));
  std::thread writer{[&] {
    std::this_thread::sleep_for(std::chrono::milliseconds{50});
    EXPECT_THAT(names_of(queue.take()), ElementsAre("results"));
  }};
  ASSERT_TRUE(queue.push(results(1)));  // This push waits for the writer.
  writer.join();
  EXPECT_EQ(queue.size(), 2U);
}

TEST(BatchQueue, GivesWhatIsLeftOnceClosedAndThenNothing) {
  BatchQueue queue{10};
  ASSERT_TRUE(queue.push(details(5)));
  ASSERT_TRUE(queue.push(results(5)));
  queue.close();
  EXPECT_FALSE(queue.push(samples(1)));
  EXPECT_THAT(names_of(queue.take()), ElementsAre("results"));
  EXPECT_THAT(names_of(queue.take()), ElementsAre("details"));
  EXPECT_TRUE(queue.take().empty());
}

TEST(BatchQueue, GivesNothingAtTheDeadlineAndIsNotDrained) {
  BatchQueue queue{1000};
  EXPECT_TRUE(queue.take(BatchQueue::Instant{}).empty());
  ASSERT_TRUE(queue.push(details(1)));
  EXPECT_TRUE(queue.take(BatchQueue::Instant{}).empty());
  queue.close();
  EXPECT_FALSE(queue.is_drained());
  EXPECT_THAT(names_of(queue.take()), ElementsAre("details"));
  EXPECT_TRUE(queue.is_drained());
}

}  // namespace spindrift::batch_queue_test
