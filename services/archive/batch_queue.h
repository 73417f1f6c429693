/// @file
/// The queue of the writer thread: samples first, then results, then details.

#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <vector>

#include "services/archive/detail_lane.h"
#include "services/archive/records.h"

namespace spindrift {

/// Queue for many submitters and one writer. Samples cannot be had again, whereas products can be
/// computed again: while samples press, most products wait, and their submitters with them. A batch
/// with products never overtakes one pushed before it, so a product is never taken before its
/// samples. A batch with details only waits for more details of its run (detail_lane.h).
/// The rows of samples and of products are bounded separately: a full queue blocks `push`. After
/// `close()` pushes are refused, and what is queued can still be taken.
class BatchQueue {
 public:
  using Instant = DetailLane::Instant;

  explicit BatchQueue(std::size_t capacity_rows) : capacity_rows_{capacity_rows} {}

  /// Waits for room, then queues `batch`.
  /// @return False when the queue is closed, or full at `until`; `batch` is then unchanged.
  bool push(ArchiveBatch&& batch, Instant until = Instant::max());

  /// Waits for at least one batch, and with samples only for a moment more, since each commit costs
  /// a sync and products wait behind it. Takes all samples; of the products many, or a small share
  /// in a burst of samples; of the details those of one run that are due. Empty only when the queue
  /// is drained or at `deadline`.
  std::vector<ArchiveBatch> take(Instant deadline = Instant::max());

  bool is_drained() const;

  void close();

  std::size_t size() const;

 private:
  struct Lane {
    std::deque<ArchiveBatch> batches;
    std::size_t rows = 0;
  };
  bool is_empty() const;
  bool is_worth_a_commit() const;
  bool is_detail_due() const;
  void wait_for_work(std::unique_lock<std::mutex>& lock, Instant deadline);
  void move_product(std::vector<ArchiveBatch>& taken);
  void move_details(std::vector<ArchiveBatch> details, std::vector<ArchiveBatch>& taken);
  static void append(ArchiveBatch batch, Lane& lane);
  static void move_first(Lane& lane, std::vector<ArchiveBatch>& taken);

  const std::size_t capacity_rows_;
  mutable std::mutex mutex_;
  std::condition_variable room_;
  std::condition_variable filled_;
  Lane samples_;
  Lane products_;
  DetailLane details_;          ///< Counts towards the bound of products.
  std::int64_t owed_rows_ = 0;  ///< Rows of products that may be taken next.
  bool closed_ = false;
};

}  // namespace spindrift
