#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <future>
#include <limits>
#include <random>
#include <span>
#include <string>
#include <thread>
#include <utility>

#include "services/archive/archive.h"
#include "tests/integration/archive_fixture.h"
#include "tests/support/matchers.h"

namespace spindrift::archive_failure_test {

using testing::batch_of;
using testing::pulse_at;
using testing::start_of;

constexpr std::int64_t kPulsesPerBatch = 1000;

ArchiveBatch pulses_from(std::int64_t first_tai_ns) {
  ArchiveBatch batch = batch_of("run-1");
  for (std::int64_t i = 0; i < kPulsesPerBatch; ++i) {
    batch.samples.of<Pulse>().push_back(pulse_at(first_tai_ns + i));
  }
  return batch;
}

/// Limits the size of every file of this process to `bytes` during its lifetime.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) {
    signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{.rlim_cur = bytes, .rlim_max = before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;
  ~FileSizeLimit() { setrlimit(RLIMIT_FSIZE, &before_); }

 private:
  rlimit before_{};
};

/// Returns a handler that fulfils `failed` with the first error only.
std::function<void(const Error&)> first_into(std::promise<Error>& failed) {
  return [&failed, reported = false](const Error& error) mutable {
    if (!std::exchange(reported, true)) {
      failed.set_value(error);
    }
  };
}

/// Returns a callback that blocks the writer after its first commit until `go_on` is ready.
std::function<void(std::span<const ArchiveBatch>)> held_until(std::shared_future<void> go_on) {
  return [go_on = std::move(go_on)](const auto& /*stored*/) { go_on.wait(); };
}

/// Reads the consecutive batch numbers that the writer reports at each commit, kills it after
/// `until_kill` of them and reads the rest.
/// @return The last number.
std::int64_t kill_after(int until_kill, pid_t writer, int reports, std::int64_t last_reported) {
  std::int64_t number = 0;
  while (read(reports, &number, sizeof number) == sizeof number) {
    EXPECT_EQ(number, last_reported + 1);
    last_reported = number;
    if (--until_kill == 0) {
      EXPECT_EQ(kill(writer, SIGKILL), 0);
    }
  }
  return last_reported;
}

class ArchiveFailure : public testing::ArchiveFixture {
 protected:
  /// Returns a file size limit with room for one small commit after the write-ahead log, not for
  /// many.
  rlim_t little_room() const {
    return std::filesystem::file_size(path().string() + "-wal") + 100'000;
  }

  /// Opens an archive that fulfils `failed` when writing fails.
  std::unique_ptr<Archive> open_watched(OnWriteFailure policy, std::promise<Error>& failed) {
    auto archive = open({.on_write_failure = policy,
                         .queue_rows = 4 * kPulsesPerBatch,
                         .on_failure = first_into(failed)});
    commit(*archive, start_of("run-1"));
    return archive;
  }

  /// Submits batches until one is refused.
  /// @return Number of accepted batches.
  static std::int64_t fill(Archive& archive) {
    std::int64_t accepted = 0;
    while (archive.submit(pulses_from(accepted * kPulsesPerBatch))) {
      ++accepted;
    }
    return accepted;
  }

  std::int64_t stored_pulses() const { return count("pulse"); }
};

TEST_F(ArchiveFailure, StopRefusesAtOnceAndClosingStoresAllThatWasAccepted) {
  std::promise<Error> failed;
  const auto archive = open_watched(OnWriteFailure::Stop, failed);
  std::int64_t accepted = 0;
  {
    const FileSizeLimit full_disk{little_room()};
    accepted = fill(*archive);
    EXPECT_EQ(failed.get_future().get().code, ErrorCode::Unavailable);
    EXPECT_THAT(archive->flush(), IsRefused(ErrorCode::Unavailable, HasSubstr(path().string())));
    EXPECT_TRUE(archive->statistics().failure.has_value());
    EXPECT_LT(stored_pulses(), accepted * kPulsesPerBatch);
  }
  const auto closed = archive->close();

  EXPECT_TRUE(closed) << closed.error().message;
  EXPECT_EQ(stored_pulses(), accepted * kPulsesPerBatch);
}

TEST_F(ArchiveFailure, ClosingOnAFullDiskSaysHowManyRowsAreNotStored) {
  std::promise<Error> failed;
  const auto archive = open_watched(OnWriteFailure::Stop, failed);
  {
    const FileSizeLimit full_disk{little_room()};
    const std::int64_t accepted = fill(*archive);
    const auto closed = archive->close();
    const std::int64_t lost = accepted * kPulsesPerBatch - stored_pulses();
    EXPECT_GT(lost, 0);
    EXPECT_THAT(closed, IsRefused(ErrorCode::Unavailable,
                                  StartsWith(std::to_string(lost) + " rows that were accepted")));
  }
  EXPECT_EQ(text("PRAGMA integrity_check"), "ok");
}

TEST_F(ArchiveFailure, RetryHoldsSubmittersAndStoresEverythingOnceThereIsRoom) {
  constexpr std::int64_t kBatches = 40;
  std::promise<Error> failed;
  const auto archive = open_watched(OnWriteFailure::Retry, failed);
  std::future<bool> submitter;
  {
    const FileSizeLimit full_disk{little_room()};
    submitter = std::async(std::launch::async, [&] {
      bool all_accepted = true;
      for (std::int64_t i = 0; i < kBatches; ++i) {
        all_accepted = archive->submit(pulses_from(i * kPulsesPerBatch)) && all_accepted;
      }
      return all_accepted;
    });
    failed.get_future().wait();
    EXPECT_EQ(submitter.wait_for(std::chrono::milliseconds{200}), std::future_status::timeout);
    EXPECT_TRUE(archive->statistics().failure.has_value());
  }
  EXPECT_TRUE(submitter.get());
  ASSERT_TRUE(archive->flush());

  EXPECT_FALSE(archive->statistics().failure.has_value());
  EXPECT_EQ(stored_pulses(), kBatches * kPulsesPerBatch);
  EXPECT_TRUE(archive->close());
}

TEST_F(ArchiveFailure, NobodyNeedsToWaitForEverBehindALockedOrFullArchive) {
  std::promise<Error> failed;
  int refused = 0;
  const auto archive = open({.on_write_failure = OnWriteFailure::Retry,
                             .queue_rows = kPulsesPerBatch,
                             .on_refused = [&](const auto& /*batch*/) { ++refused; },
                             .on_failure = first_into(failed)});
  commit(*archive, start_of("run-1"));
  const auto soon = [] { return std::chrono::steady_clock::now() + std::chrono::milliseconds{50}; };
  {
    SQLite::Database other{path().string(), SQLite::OPEN_READWRITE};
    other.exec("BEGIN IMMEDIATE");
    ASSERT_TRUE(archive->submit(pulses_from(0)));
    EXPECT_THAT(archive->flush(soon()), IsRefused(ErrorCode::Unavailable, HasSubstr("locked")));
    while (archive->submit(pulses_from(0), soon())) {
    }
    EXPECT_EQ(refused, 1);
    other.exec("ROLLBACK");
  }
  EXPECT_TRUE(archive->flush());
  const FileSizeLimit full_disk{little_room()};
  while (archive->submit(pulses_from(kPulsesPerBatch * refused), soon())) {
    ++refused;
  }
  EXPECT_THAT(archive->flush(soon()),
              IsRefused(ErrorCode::Unavailable, HasSubstr(path().string())));
}

TEST_F(ArchiveFailure, RowThatBreaksTheSchemaStopsEvenRetryAndCostsOnlyItsOwnBatch) {
  std::promise<Error> failed;
  std::promise<void> all_queued;
  const auto archive = open({.on_write_failure = OnWriteFailure::Retry,
                             .on_committed = held_until(all_queued.get_future().share()),
                             .on_failure = first_into(failed)});
  ArchiveBatch bad = batch_of("run-1");
  bad.products = {RevolutionProduct{.revolution = 1,
                                    .t_sun1 = tai_from_ns(0),
                                    .period_s = std::numeric_limits<double>::quiet_NaN()}};
  ASSERT_TRUE(archive->submit(start_of("run-1")));
  while (archive->statistics().queued_batches > 0) {
    std::this_thread::yield();
  }
  ASSERT_TRUE(archive->submit(pulses_from(0)));
  ASSERT_TRUE(archive->submit(bad));
  ASSERT_TRUE(archive->submit(pulses_from(kPulsesPerBatch)));
  all_queued.set_value();

  const Error error = failed.get_future().get();
  EXPECT_EQ(error.code, ErrorCode::InvalidInput);
  EXPECT_THAT(error.message, HasSubstr("revolution.period_s"));
  EXPECT_FALSE(archive->submit(batch_of("run-1")));
  EXPECT_THAT(archive->close(),
              IsRefused(ErrorCode::Unavailable, StartsWith("1 rows that were accepted")));
  EXPECT_EQ(stored_pulses(), 2 * kPulsesPerBatch);
}

TEST_F(ArchiveFailure, StopRefusesWhenTheFileIsDeletedAndClosingWritesItAgain) {
  std::promise<Error> failed;
  const auto archive = open_watched(OnWriteFailure::Stop, failed);
  std::filesystem::remove(path());
  const Error error = failed.get_future().get();  // The failure is reported even without a commit.
  EXPECT_THAT(error.message, HasSubstr("was deleted or moved away while it was written"));
  EXPECT_FALSE(archive->submit(pulses_from(0)));
  const auto closed = archive->close();

  EXPECT_TRUE(closed) << closed.error().message;
  EXPECT_EQ(count("run"), 1);
}

TEST_F(ArchiveFailure, ClosingSaysWhereTheRowsAreWhenAnotherFileIsAtThePath) {
  const auto archive = open();
  commit(*archive, start_of("run-1"));
  ASSERT_TRUE(archive->submit(pulses_from(0)));
  std::ofstream{directory() / "other"} << "another file";
  std::filesystem::rename(directory() / "other", path());
  EXPECT_THAT(archive->close(),
              IsRefused(ErrorCode::Unavailable, HasSubstr(path().string() + ".rescued-")));
  for (const auto& entry : std::filesystem::directory_iterator{directory()}) {
    if (entry.path().string().find(".rescued-") != std::string::npos) {
      std::filesystem::rename(entry.path(), path());
      break;
    }
  }
  EXPECT_EQ(stored_pulses(), kPulsesPerBatch);
}

TEST_F(ArchiveFailure, ClosingFailsWhenTheFileWasTruncatedThoughNothingIsLeftToStore) {
  const auto archive = open();
  commit(*archive, start_of("run-1"));
  std::filesystem::resize_file(path(), 4096);
  EXPECT_THAT(archive->close(),
              IsRefused(ErrorCode::Unavailable, HasSubstr("was truncated or overwritten")));
  EXPECT_EQ(std::filesystem::file_size(path()), 4096U);
}

/// Submits numbered batches forever and writes the number of each committed one to `reports`.
[[noreturn]] void write_until_killed(const std::filesystem::path& path, std::int64_t first,
                                     const std::string& run_id, int reports) {
  ArchiveOptions options;
  options.on_committed = [reports](std::span<const ArchiveBatch> batches) {
    for (const ArchiveBatch& batch : batches) {
      if (!batch.samples.of<Pulse>().empty()) {
        const std::int64_t number = tai_ns(batch.samples.of<Pulse>().front().value.t);
        static_cast<void>(write(reports, &number, sizeof number));
      }
    }
  };
  auto archive = Archive::open(path, options);
  if (!archive || !(*archive)->submit(start_of(run_id))) {
    _exit(1);
  }
  for (std::int64_t number = first;; ++number) {
    if (!(*archive)->submit(testing::with_pulses(batch_of(run_id), {pulse_at(number)}))) {
      _exit(1);
    }
  }
}

TEST_F(ArchiveFailure, KillAtAnyMomentLosesNothingThatWasReportedCommitted) {
  constexpr int kKills = 20;
  std::mt19937 rng{9};
  std::uniform_int_distribution<int> reports_before_kill{1, 400};
  std::int64_t last_reported = -1;

  for (int round = 0; round < kKills; ++round) {
    SCOPED_TRACE(round);
    std::array<int, 2> reports{};
    ASSERT_EQ(pipe(reports.data()), 0);
    const pid_t child = fork();
    if (child == 0) {
      write_until_killed(path(), last_reported + 1, "run-" + std::to_string(round), reports[1]);
    }
    close(reports[1]);
    last_reported = kill_after(reports_before_kill(rng), child, reports[0], last_reported);
    close(reports[0]);
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFSIGNALED(status)) << "the writer ended by itself";

    EXPECT_EQ(text("PRAGMA integrity_check"), "ok");
    EXPECT_EQ(count("pulse WHERE t_tai_ns <= " + std::to_string(last_reported)), last_reported + 1);
  }
}

TEST_F(ArchiveFailure, AnExceptionInItsThreadIsAFailure) {
  std::promise<Error> failed;
  const auto archive = open({.on_write_failure = OnWriteFailure::Retry,
                             .on_committed = [](const auto& /*stored*/) { throw std::bad_alloc{}; },
                             .on_failure = first_into(failed)});
  ASSERT_TRUE(archive->submit(start_of("run-1")));
  EXPECT_THAT(failed.get_future().get().message, HasSubstr("out of memory"));
  EXPECT_FALSE(archive->submit(pulses_from(0)));
  EXPECT_FALSE(archive->close());
}

}  // namespace spindrift::archive_failure_test
