#include "services/archive/batch_queue.h"

#include <chrono>
#include <utility>

namespace spindrift {
namespace {

// So many rows of samples press: a burst, more than come during a commit at any live rate.
constexpr std::size_t kPressing = 128;
// So long do a few samples wait for others, and for products, to share a commit.
constexpr std::chrono::milliseconds kGathering{5};
// Rows of products in one transaction: about as long do the next samples wait.
constexpr std::size_t kProductsAtOnce = 8192;
// Rows of samples for one of products while they press.
constexpr std::size_t kSamplesAProduct = 8;

bool has_products(const ArchiveBatch& batch) {
  return !batch.products.empty() || batch.continuation || batch.finished_utc;
}

}  // namespace

bool BatchQueue::push(ArchiveBatch batch) {
  const std::size_t rows = row_count(batch);
  std::unique_lock lock{mutex_};
  Lane& lane = has_products(batch) ? products_ : samples_;
  room_.wait(lock, [&] { return closed_ || lane.rows < capacity_rows_; });
  if (closed_) {
    return false;
  }
  const bool was_empty = is_empty();
  lane.batches.push_back(std::move(batch));
  lane.rows += rows;
  const bool is_news = was_empty || is_worth_a_commit();
  lock.unlock();
  if (is_news) {
    filled_.notify_one();
  }
  return true;
}

std::vector<ArchiveBatch> BatchQueue::take() {
  std::unique_lock lock{mutex_};
  filled_.wait(lock, [this] { return closed_ || !is_empty(); });
  filled_.wait_for(lock, kGathering, [this] { return closed_ || is_worth_a_commit(); });
  std::vector<ArchiveBatch> taken;
  const std::size_t sample_rows = samples_.rows;
  while (!samples_.batches.empty()) {
    move_first(samples_, taken);
  }
  if (sample_rows >= kPressing) {
    allowance_rows_ += sample_rows / kSamplesAProduct;
    while (!products_.batches.empty() && row_count(products_.batches.front()) <= allowance_rows_) {
      allowance_rows_ -= row_count(products_.batches.front());
      move_first(products_, taken);
    }
  } else {
    allowance_rows_ = 0;
    const std::size_t left = products_.rows;
    while (!products_.batches.empty() && left - products_.rows < kProductsAtOnce) {
      move_first(products_, taken);
    }
  }
  lock.unlock();
  room_.notify_all();
  return taken;
}

bool BatchQueue::is_empty() const { return samples_.batches.empty() && products_.batches.empty(); }

bool BatchQueue::is_worth_a_commit() const {
  return !products_.batches.empty() || samples_.rows >= kPressing;
}

void BatchQueue::move_first(Lane& lane, std::vector<ArchiveBatch>& taken) {
  lane.rows -= row_count(lane.batches.front());
  taken.push_back(std::move(lane.batches.front()));
  lane.batches.pop_front();
}

void BatchQueue::close() {
  {
    const std::lock_guard lock{mutex_};
    closed_ = true;
  }
  room_.notify_all();
  filled_.notify_all();
}

std::size_t BatchQueue::size() const {
  const std::lock_guard lock{mutex_};
  return samples_.batches.size() + products_.batches.size();
}

}  // namespace spindrift
