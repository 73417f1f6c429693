/// @file
/// The archive as a service uses it: batches go in, and a thread of its own stores them.

#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "pipelines/core/expected.h"
#include "services/archive/batch_queue.h"
#include "services/archive/recent_durations.h"
#include "services/archive/records.h"
#include "services/archive/store.h"
#include "services/archive/write_lock.h"
#include "services/base/duration_histogram.h"

namespace spindrift {

/// Says what follows a write that failed because of disk space, I/O or the lock. Batches that were
/// accepted are kept in either case. A row that violates the schema always stops the archive.
enum class OnWriteFailure {
  Stop,   ///< For a run of files: refuses further batches, tries once more when closing.
  Retry,  ///< For a pass under way: submitters wait, and writing is tried every second.
};

/// Options of an archive. The callbacks, except on_submit and on_refused, run on the writer thread.
/// None may throw or call the archive.
struct ArchiveOptions {
  OnWriteFailure on_write_failure = OnWriteFailure::Stop;
  std::size_t queue_rows = 65536;  ///< Limit for the rows of samples, and again for products.
  /// Called with each batch before it is queued, on the submitting thread; may add products to it.
  std::function<void(ArchiveBatch&)> on_submit = [](auto& /*batch*/) {};
  /// Called with each batch that `submit` refuses.
  std::function<void(const ArchiveBatch&)> on_refused = [](const auto& /*batch*/) {};
  /// Called after each commit with the batches it stored.
  std::function<void(std::span<const ArchiveBatch>)> on_committed = [](const auto& /*stored*/) {};
  /// Called when writing begins to fail, and when the reason of the failure changes.
  std::function<void(const Error&)> on_failure = [](const auto& /*error*/) {};
};

struct ArchiveStatistics {
  std::uint64_t rows_committed = 0;     ///< Counts submitted rows, even of pulses stored before.
  std::uint64_t samples_committed = 0;  ///< Samples of telemetry among those rows.
  std::size_t queued_batches = 0;
  std::optional<double> commit_p99_ms;  ///< Duration of the last 1000 transactions.
  DurationHistogram commits = {};       ///< Durations of all transactions.
  std::optional<Error> failure;         ///< Set while writing fails, or after it stopped.
  std::uint64_t failures = 0;           ///< Number of failed writes.
  double log_mib = 0.0;                 ///< Length of the write-ahead log after the last commit.
};

/// An archive open for writing. Everything queued goes into one transaction, and the next
/// transaction begins as soon as it is committed. Samples are stored in the order submitted. So are
/// products, and never before samples submitted before them (batch_queue.h). Before each commit,
/// and once a second, the archive checks that its path still leads to its file. If the file was
/// deleted, moved away or replaced, it is copied from the open connection, which still has all of
/// it, and writing goes on in the copy as soon as the path is free; nothing is stored until then.
/// If the file was truncated or overwritten, it is not written any more. Both count as failures of
/// writing. `submit`, `flush` and `statistics` may be called from any thread. `close` may be called
/// from one thread, after which the others return errors.
class Archive {
 public:
  /// @return Unavailable when a process (this one included) writes the archive already, or it
  /// cannot be opened; InvalidConfiguration when the path cannot be that of a file, or the file is
  /// not an archive or has another schema than this program's.
  static Expected<std::unique_ptr<Archive>> open(const std::filesystem::path& path,
                                                 ArchiveOptions options);

  Archive(const Archive&) = delete;
  Archive& operator=(const Archive&) = delete;
  Archive(Archive&&) = delete;
  Archive& operator=(Archive&&) = delete;
  ~Archive();

  using Instant = BatchQueue::Instant;

  /// Takes over `batch`. Waits while the queue is full and, with Retry, while writing fails.
  /// @return The failure that stopped the archive; Unavailable after `close` or at `until`.
  Expected<void> submit(ArchiveBatch batch, Instant until = Instant::max());

  /// Waits until everything submitted is committed and announced. @return Errors as `submit`.
  Expected<void> flush(Instant until = Instant::max());

  /// Stores what is still queued, with one more attempt for what failed, and releases the file.
  /// @return Unavailable with the number of accepted rows that could not be stored, or with the
  /// path where they are when another file is at the archive's path; also when the file is damaged.
  Expected<void> close();

  ArchiveStatistics statistics() const;

 private:
  enum class State { Accepting, Stopped, Closing };

  Archive(std::string path, WriteLock lock, std::unique_ptr<Store> store, ArchiveOptions options);

  void run();
  void store_what_comes();
  void give_up(const Error& error);
  bool store_patiently(std::span<const ArchiveBatch> batches);
  void store_singly(std::span<const ArchiveBatch> batches);
  Expected<void> store(std::span<const ArchiveBatch> batches);
  Expected<void> put_right();
  Expected<void> put_back();
  Expected<void> reopen(const std::filesystem::path& path);
  bool is_closing() const;
  void note_success(std::span<const ArchiveBatch> batches, double duration_ms);
  void note_failure(const Error& error);
  bool close_comes_first();
  Unexpected refusal() const;

  const std::string path_;
  const ArchiveOptions options_;
  std::optional<WriteLock> lock_;
  BatchQueue queue_;

  std::unique_ptr<Store> store_;               ///< Null when it must be opened again.
  bool displaced_ = false;                     ///< Reported: the file is not at its path.
  std::optional<std::filesystem::path> copy_;  ///< Copy of all committed rows, not yet at the path.
  std::optional<std::filesystem::path> refuge_;  ///< The copy, when the path stayed taken.
  Expected<void> end_;
  bool gave_up_ = false;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  State state_ = State::Accepting;
  std::optional<Error> failure_;
  std::uint64_t submitted_batches_ = 0;
  std::uint64_t committed_batches_ = 0;
  std::uint64_t rows_committed_ = 0;
  std::uint64_t samples_committed_ = 0;
  std::uint64_t failures_ = 0;
  double log_mib_ = 0.0;
  std::size_t rows_lost_ = 0;
  RecentDurations commit_durations_;
  DurationHistogram commits_;

  std::thread writer_;
};

}  // namespace spindrift
