/// @file
/// The archive as a service sees it: batches go in, a thread of its own stores them.

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

/// What follows a write that failed for want of disk, I/O or the lock. Batches already accepted
/// are kept in either case. A row that breaks a rule of the schema always stops.
enum class OnWriteFailure {
  Stop,   ///< Refuse what is submitted from now on; try once more when closing. For a file's run.
  Retry,  ///< Let submitters wait, and try every second. For a pass that is under way.
};

/// The callbacks run on the writer thread but for on_submit and on_refused, must not throw and must
/// not call the archive.
struct ArchiveOptions {
  OnWriteFailure on_write_failure = OnWriteFailure::Stop;
  std::size_t queue_rows = 65536;  ///< Of samples, and as many of products.
  /// Of what is submitted, by the thread that does, before it is queued: may add products to it.
  std::function<void(ArchiveBatch&)> on_submit = [](auto& /*batch*/) {};
  /// Of what was shown to on_submit and is not queued, since the archive closes.
  std::function<void(const ArchiveBatch&)> on_refused = [](const auto& /*batch*/) {};
  /// After each commit, with what it stored.
  std::function<void(std::span<const ArchiveBatch>)> on_committed = [](const auto& /*stored*/) {};
  /// When writing begins to fail, and whenever it fails for another reason than before.
  std::function<void(const Error&)> on_failure = [](const auto& /*error*/) {};
};

struct ArchiveStatistics {
  std::uint64_t rows_committed = 0;     ///< As submitted: a pulse that was stored before counts.
  std::uint64_t samples_committed = 0;  ///< The samples of telemetry among them.
  std::size_t queued_batches = 0;
  std::optional<double> commit_p99_ms;  ///< Whole transactions, the last 1000 of them.
  DurationHistogram commits = {};       ///< All of them.
  std::optional<Error> failure;         ///< Writing fails at present, or failed and stopped.
  std::uint64_t failures = 0;           ///< Writes that failed.
};

/// One archive open for writing. What is queued goes into one transaction, and the next one begins
/// as soon as it is committed: few batches are stored at once, many at the rate of the disk.
/// Samples are stored in the order submitted, products in theirs and never before samples that were
/// submitted before them; see batch_queue.h.
///
/// Before each commit, and once a second, it is looked whether the file is still the one at the
/// path. One that was deleted, moved away or replaced is copied from the connection, which has it
/// whole, and the copy goes on at its path as soon as nothing else stands there; nothing is stored
/// until then. One that was truncated or overwritten is not written any more. Both are failures of
/// writing.
///
/// `submit`, `flush` and `statistics` may be called from any thread; `close` from one, after which
/// the others give errors.
class Archive {
 public:
  /// @return Unavailable when another process (or this one) writes it, or it cannot be opened;
  ///         InvalidConfiguration when the path cannot be that of a file, or the file is not an
  ///         archive or has another schema than this program's.
  static Expected<std::unique_ptr<Archive>> open(const std::filesystem::path& path,
                                                 ArchiveOptions options);

  Archive(const Archive&) = delete;
  Archive& operator=(const Archive&) = delete;
  Archive(Archive&&) = delete;
  Archive& operator=(Archive&&) = delete;
  ~Archive();

  /// Takes `batch` over; waits while the queue is full and, with Retry, while writing fails.
  /// @return the failure that stopped the archive, or Unavailable after `close`.
  Expected<void> submit(ArchiveBatch batch);

  /// Waits until everything submitted is committed and announced.
  /// @return as `submit`.
  Expected<void> flush();

  /// Stores what is still queued, trying once more what failed, and lets go of the file.
  /// @return Unavailable with the number of rows that were accepted and could not be stored, or
  ///         where they are when something else stands at the path; also when the file is damaged.
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

  // Of the writer thread.
  std::unique_ptr<Store> store_;                 ///< Empty: to be opened again.
  bool displaced_ = false;                       ///< Its file is not at the path, as was said.
  std::optional<std::filesystem::path> copy_;    ///< With all that is committed, for the path.
  std::optional<std::filesystem::path> refuge_;  ///< Where it ended instead of at the path.
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
  std::size_t rows_lost_ = 0;
  RecentDurations commit_durations_;
  DurationHistogram commits_;

  std::thread writer_;
};

}  // namespace spindrift
