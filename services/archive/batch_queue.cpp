#include "services/archive/batch_queue.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <utility>

namespace spindrift {
namespace {

using std::chrono::steady_clock;

// Samples press (a burst) at this many rows: more than come during a commit at a live rate.
constexpr std::size_t kPressing = 128;
// Time that a few samples wait for more samples or products, to share a commit.
constexpr std::chrono::milliseconds kGathering{5};
// Rows of products in one transaction; the next samples wait about as long as it takes.
constexpr std::int64_t kProductsAtOnce = 8192;
// This many rows of details no longer wait for a commit without results.
constexpr std::size_t kManyDetails = 8192;
// While samples press, one row of products is taken per this many rows of samples.
constexpr std::int64_t kSamplesAProduct = 8;

std::int64_t signed_size(std::size_t size) { return static_cast<std::int64_t>(size); }

/// Three kinds of batches go with the samples, whatever else is in them: the first of a run,
/// because the rows of all others refer to the run and the spacecraft that it begins; one with
/// samples, because what is stored is always what has arrived up to some moment; and one with
/// counts of sources, because these are cumulative and the last ones stored hold.
bool waits_as_product(const ArchiveBatch& batch) {
  return !batch.start && count_of(batch.samples) == 0 && count_of(batch.moved) == 0 &&
         batch.source_counts.empty() &&
         (!batch.products.empty() || batch.continuation || batch.finished_utc);
}

bool has_details(const ArchiveBatch& batch) {
  return std::any_of(batch.products.begin(), batch.products.end(), is_detail);
}

bool has_details_only(const ArchiveBatch& batch) {
  return !batch.products.empty() && row_count(batch) == batch.products.size() &&
         !batch.continuation &&
         std::all_of(batch.products.begin(), batch.products.end(), is_detail);
}

}  // namespace

bool BatchQueue::push(ArchiveBatch&& batch, Instant until) {
  const bool are_details = has_details_only(batch);
  const bool are_products = waits_as_product(batch);
  std::unique_lock lock{mutex_};
  const bool has_room = room_.wait_until(lock, until, [&] {
    return closed_ ||
           capacity_rows_ > (are_products ? products_.rows + details_.rows() : samples_.rows);
  });
  if (closed_ || !has_room) {
    return false;
  }
  // Waiting details do not wake the writer before they are due; samples and results do.
  const bool was_empty = is_empty() && (!are_details || details_.rows() == 0);
  if (are_details) {
    details_.push(std::move(batch), steady_clock::now());
  } else {
    if (batch.continuation || batch.finished_utc || has_details(batch)) {
      for (ArchiveBatch& earlier : details_.take_all(batch.run_id)) {
        append(std::move(earlier), products_);
      }
    }
    append(std::move(batch), are_products ? products_ : samples_);
  }
  const bool is_news = was_empty || is_worth_a_commit() || (are_details && is_detail_due());
  lock.unlock();
  if (is_news) {
    filled_.notify_one();
  }
  return true;
}

std::vector<ArchiveBatch> BatchQueue::take(Instant deadline) {
  std::unique_lock lock{mutex_};
  wait_for_work(lock, deadline);
  std::vector<ArchiveBatch> taken;
  const bool is_pressing = samples_.rows >= kPressing;
  owed_rows_ =
      is_pressing ? owed_rows_ + signed_size(samples_.rows) / kSamplesAProduct : kProductsAtOnce;
  while (!samples_.batches.empty()) {
    move_first(samples_, taken);
  }
  const std::size_t without_products = taken.size();
  while (owed_rows_ > 0 && !products_.batches.empty()) {
    move_product(taken);
  }
  const bool has_products = taken.size() > without_products;
  if (owed_rows_ > 0 && (!has_products || details_.rows() >= kManyDetails)) {
    move_details(details_.take_due(closed_ ? Instant::max() : steady_clock::now(),
                                   static_cast<std::size_t>(owed_rows_)),
                 taken);
  }
  owed_rows_ = is_pressing ? owed_rows_ : 0;
  lock.unlock();
  room_.notify_all();
  return taken;
}

// With samples only, waits a moment longer, so that more of them share a commit.
void BatchQueue::wait_for_work(std::unique_lock<std::mutex>& lock, Instant deadline) {
  const auto is_due = [this] { return closed_ || !is_empty() || is_detail_due(); };
  while (!is_due()) {
    if (steady_clock::now() >= deadline) {
      return;
    }
    filled_.wait_until(lock, std::min(deadline, details_.next_due().value_or(deadline)));
  }
  filled_.wait_for(lock, kGathering,
                   [this] { return closed_ || is_worth_a_commit() || is_detail_due(); });
}

bool BatchQueue::is_empty() const { return samples_.batches.empty() && products_.batches.empty(); }

bool BatchQueue::is_worth_a_commit() const {
  return !products_.batches.empty() || samples_.rows >= kPressing;
}

bool BatchQueue::is_detail_due() const {
  const auto next = details_.next_due();
  return next && *next <= steady_clock::now();
}

void BatchQueue::move_product(std::vector<ArchiveBatch>& taken) {
  owed_rows_ -= signed_size(row_count(products_.batches.front()));
  move_first(products_, taken);
}

void BatchQueue::move_details(std::vector<ArchiveBatch> details, std::vector<ArchiveBatch>& taken) {
  for (ArchiveBatch& batch : details) {
    owed_rows_ -= signed_size(row_count(batch));
    taken.push_back(std::move(batch));
  }
}

void BatchQueue::append(ArchiveBatch batch, Lane& lane) {
  lane.rows += row_count(batch);
  lane.batches.push_back(std::move(batch));
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

bool BatchQueue::is_drained() const {
  const std::lock_guard lock{mutex_};
  return closed_ && is_empty() && details_.rows() == 0;
}

std::size_t BatchQueue::size() const {
  const std::lock_guard lock{mutex_};
  return samples_.batches.size() + products_.batches.size() + details_.size();
}

}  // namespace spindrift
