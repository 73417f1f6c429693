#include "services/archive/batch_queue.h"

#include <utility>

namespace spindrift {
namespace {

// So many rows of samples press: a burst, more than come during a commit at any live rate.
constexpr std::size_t kPressing = 128;
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
  lane.batches.push_back(std::move(batch));
  lane.rows += rows;
  lock.unlock();
  filled_.notify_one();
  return true;
}

std::vector<ArchiveBatch> BatchQueue::take() {
  std::unique_lock lock{mutex_};
  filled_.wait(
      lock, [this] { return closed_ || !samples_.batches.empty() || !products_.batches.empty(); });
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
