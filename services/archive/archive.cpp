#include "services/archive/archive.h"

#include <fmt/format.h>

#include <chrono>
#include <numeric>
#include <string_view>
#include <system_error>
#include <utility>

#include "services/archive/connection.h"
#include "services/base/contained.h"

namespace spindrift {
namespace {

using std::chrono::steady_clock;

constexpr std::chrono::seconds kRetryPause{1};
// When there is nothing to store, the file is checked once per this period.
constexpr std::chrono::seconds kLookPeriod{1};
constexpr std::size_t kCommitsRemembered = 1000;

std::size_t row_count(std::span<const ArchiveBatch> batches) {
  return std::accumulate(
      batches.begin(), batches.end(), std::size_t{0},
      [](std::size_t sum, const ArchiveBatch& batch) { return sum + spindrift::row_count(batch); });
}

// Links are resolved so that one file has one lock, whichever link it is reached by.
Expected<std::filesystem::path> resolved(const std::filesystem::path& path) {
  if (path.empty()) {
    return no_archive_at(path, "must be the path of a file");
  }
  if (const auto named = refuse_no_file(path); !named) {
    return Unexpected{named.error()};
  }
  std::error_code unresolved;
  auto real = std::filesystem::absolute(path, unresolved);
  if (!unresolved) {
    real = std::filesystem::weakly_canonical(real, unresolved);
  }
  if (unresolved) {
    return Unexpected{{ErrorCode::Unavailable,
                       fmt::format("archive {}: {}", path.string(), unresolved.message())}};
  }
  std::error_code unknown;  // A path that cannot be examined fails later, at the lock.
  if (!std::filesystem::is_directory(real.parent_path(), unknown)) {
    return no_archive_at(path,
                         fmt::format("there is no directory {}", real.parent_path().string()));
  }
  return real;
}

}  // namespace

Expected<std::unique_ptr<Archive>> Archive::open(const std::filesystem::path& path,
                                                 ArchiveOptions options) {
  const auto real = resolved(path);
  if (!real) {
    return Unexpected{real.error()};
  }
  // Checked before the lock is taken, because taking it creates a file beside the archive.
  if (const auto ours = refuse_foreign_file(*real); !ours) {
    return Unexpected{ours.error()};
  }
  auto lock = WriteLock::acquire(*real);
  if (!lock) {
    return Unexpected{lock.error()};
  }
  auto store = Store::open(*real);
  if (!store) {
    return Unexpected{store.error()};
  }
  return std::unique_ptr<Archive>{
      new Archive{real->string(), std::move(*lock), std::move(*store), std::move(options)}};
}

Archive::Archive(std::string path, WriteLock lock, std::unique_ptr<Store> store,
                 ArchiveOptions options)
    : path_{std::move(path)},
      options_{std::move(options)},
      lock_{std::move(lock)},
      queue_{options_.queue_rows},
      store_{std::move(store)},
      commit_durations_{kCommitsRemembered},
      writer_{[this] { run(); }} {}

// A caller that needs to know what was not stored calls close() before.
Archive::~Archive() { static_cast<void>(close()); }

Expected<void> Archive::submit(ArchiveBatch batch, Instant until) {
  {
    std::unique_lock lock{mutex_};
    const bool can_end = changed_.wait_until(
        lock, until, [this] { return state_ != State::Accepting || !failure_; });
    if (!can_end || state_ != State::Accepting) {
      lock.unlock();
      options_.on_refused(batch);
      lock.lock();
      return refusal();
    }
  }
  options_.on_submit(batch);
  {
    const std::lock_guard lock{mutex_};
    ++submitted_batches_;
  }
  if (!queue_.push(std::move(batch), until)) {
    // NOLINTNEXTLINE(bugprone-use-after-move): a queue that refuses leaves it as it was.
    options_.on_refused(batch);
    const std::lock_guard lock{mutex_};
    --submitted_batches_;
    return refusal();
  }
  return {};
}

Expected<void> Archive::flush(Instant until) {
  std::unique_lock lock{mutex_};
  const auto is_done = [this] { return committed_batches_ == submitted_batches_; };
  changed_.wait_until(lock, until, [&] { return state_ != State::Accepting || is_done(); });
  if (!is_done()) {
    return refusal();
  }
  return {};
}

Expected<void> Archive::close() {
  {
    const std::lock_guard lock{mutex_};
    state_ = State::Closing;
  }
  changed_.notify_all();
  queue_.close();
  if (writer_.joinable()) {
    writer_.join();
  }
  store_.reset();
  lock_.reset();
  if (rows_lost_ > 0 || gave_up_) {
    return Unexpected{
        {ErrorCode::Unavailable, fmt::format("{} rows that were accepted are not in archive {}: {}",
                                             rows_lost_, path_, failure_->message)}};
  }
  if (refuge_) {
    return Unexpected{
        {ErrorCode::Unavailable,
         fmt::format("{} rows that were accepted are not in archive {}, where another file stands, "
                     "but in {}, with all that was stored before",
                     rows_committed_, path_, refuge_->string())}};
  }
  return end_;
}

ArchiveStatistics Archive::statistics() const {
  const std::lock_guard lock{mutex_};
  return {.rows_committed = rows_committed_,
          .samples_committed = samples_committed_,
          .queued_batches = queue_.size(),
          .commit_p99_ms = commit_durations_.percentile_ms(99),
          .commits = commits_,
          .failure = failure_,
          .failures = failures_,
          .log_mib = log_mib_};
}

void Archive::run() {
  if (const auto ended = contained("archive " + path_, [this] { store_what_comes(); }); !ended) {
    give_up(ended.error());
  }
}

// Called when the writer thread ends too early: what is queued is not stored.
void Archive::give_up(const Error& error) {
  {
    const std::lock_guard lock{mutex_};
    state_ = State::Stopped;
    failure_ = error;
  }
  gave_up_ = true;
  changed_.notify_all();
  queue_.close();
  for (auto left = queue_.take(); !left.empty(); left = queue_.take()) {
    rows_lost_ += row_count(left);
  }
  options_.on_failure(error);
}

void Archive::store_what_comes() {
  while (!queue_.is_drained()) {
    const auto batches = queue_.take(steady_clock::now() + kLookPeriod);
    if (gave_up_ || !store_patiently(batches)) {
      store_singly(batches);
    }
  }
  end_ = store({});
}

bool Archive::store_patiently(std::span<const ArchiveBatch> batches) {
  auto stored = store(batches);
  while (!stored && !close_comes_first()) {
    stored = store(batches);
  }
  return stored.has_value();
}

// Makes the last attempt, batch by batch, so that a bad row costs only its own batch. When writing
// itself fails, no later batch is stored either: a result must not be in the archive without the
// samples that it rests on.
void Archive::store_singly(std::span<const ArchiveBatch> batches) {
  for (std::size_t i = 0; i < batches.size(); ++i) {
    const auto one = batches.subspan(i, 1);
    const auto stored = gave_up_ ? Expected<void>{refusal()} : store(one);
    if (!stored) {
      rows_lost_ += row_count(one);
      gave_up_ = gave_up_ || stored.error().code != ErrorCode::InvalidInput;
    }
  }
}

Expected<void> Archive::store(std::span<const ArchiveBatch> batches) {
  const auto begun = steady_clock::now();
  auto stored = contained("archive " + path_, [&] {
    auto right = put_right();
    return right && !batches.empty() ? store_->write(batches) : right;
  });
  const std::chrono::duration<double, std::milli> duration = steady_clock::now() - begun;
  if (stored) {
    if (!batches.empty()) {
      options_.on_committed(batches);
    }
    note_success(batches, duration.count());
  } else {
    note_failure(stored.error());
  }
  return stored;
}

Expected<void> Archive::put_right() {
  if (!store_) {
    return reopen(path_);
  }
  if (copy_) {
    return put_back();
  }
  if (auto whole = store_->undamaged(); !whole) {
    return whole;
  }
  auto place = store_->file().in_place();
  const bool is_news = !std::exchange(displaced_, !place);
  // The first time it is only reported, because whoever is moving files may not have finished.
  return place || (is_news && !is_closing()) ? place : put_back();
}

// Puts the archive back at its path by a copy. The copy is made at once, since a file without a
// name ends with this process. On closing, if the path is not free, it stays where it is.
Expected<void> Archive::put_back() {
  const ArchiveFile& file = store_->file();
  if (!copy_) {
    const auto copy = store_->copy();
    if (!copy) {
      return Unexpected{
          {copy.error().code, fmt::format("{}, and what it had cannot be written again: {}",
                                          file.in_place().error().message, copy.error().message)}};
    }
    copy_ = *copy;
  }
  if (const auto in_the_way = file.in_the_way()) {
    file.take_log_away();
    if (is_closing()) {
      refuge_ = std::exchange(copy_, std::nullopt);
      return reopen(*refuge_);
    }
    return Unexpected{
        {ErrorCode::Unavailable,
         fmt::format("archive {}: another file stands at {}, and all that was stored is in {}. "
                     "Move the other file away, or put the right one back, and storing goes on",
                     path_, in_the_way->string(), copy_->string())}};
  }
  if (auto placed = file.give_way_to(*copy_); !placed) {
    return placed;
  }
  copy_.reset();
  return reopen(path_);
}

Expected<void> Archive::reopen(const std::filesystem::path& path) {
  store_.reset();
  auto opened = Store::open(path);
  if (!opened) {
    return Unexpected{opened.error()};
  }
  store_ = std::move(*opened);
  displaced_ = false;
  return {};
}

bool Archive::is_closing() const {
  const std::lock_guard lock{mutex_};
  return state_ == State::Closing;
}

void Archive::note_success(std::span<const ArchiveBatch> batches, double duration_ms) {
  {
    const std::lock_guard lock{mutex_};
    if (!batches.empty()) {
      commit_durations_.add(duration_ms);
      commits_.add(duration_ms * 1e-3);
    }
    log_mib_ = store_->log_mib();
    rows_committed_ += row_count(batches);
    for (const ArchiveBatch& batch : batches) {
      samples_committed_ += count_of(batch.samples);
    }
    committed_batches_ += batches.size();
    if (state_ == State::Accepting) {
      failure_.reset();
    }
  }
  changed_.notify_all();
}

void Archive::note_failure(const Error& error) {
  bool is_news = false;
  bool stops = false;
  {
    const std::lock_guard lock{mutex_};
    is_news = !failure_ || failure_->message != error.message;
    failure_ = error;
    ++failures_;
    stops = state_ == State::Accepting && (options_.on_write_failure == OnWriteFailure::Stop ||
                                           error.code == ErrorCode::InvalidInput);
    if (stops) {
      state_ = State::Stopped;
    }
  }
  if (stops) {
    changed_.notify_all();
    queue_.close();
  }
  if (is_news) {
    options_.on_failure(error);
  }
}

// Waits until the next attempt is due. A stopped archive makes its next attempt when it is closed.
bool Archive::close_comes_first() {
  std::unique_lock lock{mutex_};
  const auto closing = [this] { return state_ == State::Closing; };
  if (state_ == State::Stopped) {
    changed_.wait(lock, closing);
    return true;
  }
  return changed_.wait_for(lock, kRetryPause, closing);
}

Unexpected Archive::refusal() const {
  if (failure_) {
    return Unexpected{*failure_};
  }
  return Unexpected{{ErrorCode::Unavailable,
                     fmt::format("archive {} is {}", path_,
                                 state_ == State::Accepting
                                     ? "busy: another program holds it locked, or it cannot keep up"
                                     : "closed")}};
}

}  // namespace spindrift
