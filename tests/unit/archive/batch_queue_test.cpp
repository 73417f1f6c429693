#include "services/archive/batch_queue.h"

#include <chrono>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "tests/support/matchers.h"

namespace spindrift::batch_queue_test {

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

template <class... Batches>
void push(BatchQueue& queue, Batches... batches) {
  if (!(queue.push(std::move(batches)) && ...)) {
    throw std::runtime_error{"the queue refuses a batch"};
  }
}

std::vector<std::string> names_of(const std::vector<ArchiveBatch>& batches) {
  std::vector<std::string> names;
  for (const ArchiveBatch& batch : batches) {
    names.push_back(batch.run_id);
  }
  return names;
}

struct LongBatchQueue : ::testing::Test {
  BatchQueue queue{100'000};
};

TEST(BatchQueue, GivesSamplesFirstAndAllWhenThereAreFew) {
  BatchQueue queue{1000};
  push(queue, results(10), samples(10), results(10));
  EXPECT_THAT(names_of(queue.take()), ElementsAre("samples", "results", "results"));
}

TEST(BatchQueue, BeginsARunBeforeItsSamplesWhateverIsToldWithIt) {
  BatchQueue queue{1000};
  ArchiveBatch first = batch_of("first");
  first.start.emplace();
  first.products.emplace_back(RunNotice{});
  push(queue, std::move(first), samples(10));
  EXPECT_THAT(names_of(queue.take()), ElementsAre("first", "samples"));
}

TEST(BatchQueue, KeepsSamplesInOrderWhateverIsToldWithThem) {
  BatchQueue queue{1000};
  ArchiveBatch told = samples(10);
  told.run_id = "told";
  told.products.emplace_back(RunNotice{});
  push(queue, std::move(told), samples(10));
  EXPECT_THAT(names_of(queue.take()), ElementsAre("told", "samples"));
}

TEST(BatchQueue, KeepsCountsOfSourcesInOrderWhateverIsToldWithThem) {
  BatchQueue queue{1000};
  ArchiveBatch noticed = batch_of("noticed");
  noticed.source_counts.push_back({.source = "station", .received = 1});
  noticed.products.emplace_back(RunNotice{});
  push(queue, std::move(noticed), samples(10));
  EXPECT_THAT(names_of(queue.take()), ElementsAre("noticed", "samples"));
}

TEST_F(LongBatchQueue, LetsProductsWaitInABurstOfSamplesButNotForEver) {
  push(queue, results(500), results(500), samples(3200));
  EXPECT_THAT(names_of(queue.take()), ElementsAre("samples", "results"));
  push(queue, samples(800));
  EXPECT_THAT(names_of(queue.take()), ElementsAre("samples"));
  push(queue, samples(800));
  EXPECT_THAT(names_of(queue.take()), ElementsAre("samples", "results"));
}

TEST_F(LongBatchQueue, ForgetsWhatABurstOwesOnceItIsOver) {
  push(queue, results(50'000), results(10), samples(200));
  EXPECT_THAT(names_of(queue.take()), ElementsAre("samples", "results"));
  EXPECT_THAT(names_of(queue.take()), ElementsAre("results"));
}

TEST_F(LongBatchQueue, LetsDetailsWaitForACommitWithoutResults) {
  push(queue, details(100), results(1), samples(1));
  EXPECT_THAT(names_of(queue.take()), ElementsAre("samples", "results"));
  EXPECT_EQ(queue.size(), 1U);
  EXPECT_THAT(names_of(queue.take()), ElementsAre("details"));
}

TEST_F(LongBatchQueue, TakesManyDetailsAlongWithResults) {
  push(queue, details(9000), results(1));
  EXPECT_THAT(names_of(queue.take()), ElementsAre("results", "details"));
}

TEST_F(LongBatchQueue, GivesAFewDetailsLate) {
  using std::chrono::steady_clock;
  const auto start = steady_clock::now();
  push(queue, details(1), details(1));
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
    push(queue, details(1));
    std::vector<ArchiveBatch> taken;
    std::thread writer{[&] { taken = queue.take(); }};
    // Let the writer wait for the details.
    std::this_thread::sleep_for(std::chrono::milliseconds{50});
    push(queue, samples(1));
    writer.join();
    if (steady_clock::now() - start < std::chrono::milliseconds{900}) {
      EXPECT_THAT(names_of(taken), ElementsAre("samples"));
      EXPECT_EQ(queue.size(), 1U);
      return;
    }
  }
  GTEST_SKIP() << "the machine is too busy to be in time";
}

TEST_F(LongBatchQueue, EndsARunAfterItsDetails) {
  ArchiveBatch end = batch_of("A");
  end.finished_utc = "2026-11-20T04:00:00Z";
  push(queue, details(3, "B"), details(3, "A"), std::move(end));
  const auto taken = queue.take();
  EXPECT_THAT(names_of(taken), ElementsAre("A", "A"));
  EXPECT_TRUE(taken.back().finished_utc);
}

TEST_F(LongBatchQueue, WithdrawsDetailsFromBeforeAndNotThoseMadeAgain) {
  ArchiveBatch again = results(1, "A");
  again.continuation = Continuation{.t = TaiTime::min()};
  push(queue, details(3, "A"), std::move(again), details(100, "A"));
  const auto taken = queue.take();
  ASSERT_THAT(names_of(taken), ElementsAre("A", "A"));
  EXPECT_TRUE(taken.back().continuation);
  EXPECT_EQ(row_count(queue.take().at(0)), 100U);
}

TEST(BatchQueue, HasOneBoundForResultsAndDetails) {
  BatchQueue queue{20};
  push(queue, details(10), results(10));
  std::thread writer{[&] {
    std::this_thread::sleep_for(std::chrono::milliseconds{50});
    EXPECT_THAT(names_of(queue.take()), ElementsAre("results"));
  }};
  push(queue, results(1));  // This push waits for the writer.
  writer.join();
  EXPECT_EQ(queue.size(), 2U);
}

TEST(BatchQueue, GivesWhatIsLeftOnceClosedAndThenNothing) {
  BatchQueue queue{10};
  push(queue, details(5), results(5));
  queue.close();
  EXPECT_FALSE(queue.push(samples(1)));
  EXPECT_THAT(names_of(queue.take()), ElementsAre("results"));
  EXPECT_THAT(names_of(queue.take()), ElementsAre("details"));
  EXPECT_TRUE(queue.take().empty());
}

TEST(BatchQueue, GivesNothingAtTheDeadlineAndIsNotDrained) {
  BatchQueue queue{1000};
  EXPECT_TRUE(queue.take(BatchQueue::Instant{}).empty());
  push(queue, details(1));
  EXPECT_TRUE(queue.take(BatchQueue::Instant{}).empty());
  queue.close();
  EXPECT_FALSE(queue.is_drained());
  EXPECT_THAT(names_of(queue.take()), ElementsAre("details"));
  EXPECT_TRUE(queue.is_drained());
}

}  // namespace spindrift::batch_queue_test
