#include <gtest/gtest.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <random>
#include <utility>

#include "tests/integration/archive_fixture.h"
#include "tests/support/eventually.h"

namespace {

std::atomic<int> times_brought_to_the_disk = 0;

}  // namespace

// Replaces the C library's function so that calls are counted.
extern "C" int sync_file_range(int file, off64_t offset, off64_t count, unsigned flags) {
  ++times_brought_to_the_disk;
  return static_cast<int>(syscall(SYS_sync_file_range, file, offset, count, flags));
}

namespace spindrift {
namespace {

using testing::batch_of;
using testing::start_of;

constexpr std::uintmax_t kMiB = 1 << 20;
constexpr int kPulsesPerBatch = 6000;

/// Number of batches whose log exceeds the size at which a checkpoint is made.
constexpr int kBatchesOfALongLog = 48;

class ArchiveLog : public testing::ArchiveFixture {
 protected:
  /// Writes pulses mostly on pages of their own, so that each makes the log grow by a page.
  void write_long_log(Archive& archive) {
    for (int i = 0; i < kBatchesOfALongLog; ++i) {
      ArchiveBatch batch = batch_of("run");
      for (int row = 0; row < kPulsesPerBatch; ++row) {
        batch.samples.of<Pulse>().push_back(testing::pulse_at(anywhere_(random_)));
      }
      ASSERT_TRUE(archive.submit(std::move(batch)));
      ASSERT_TRUE(archive.flush());
      pulses_ += kPulsesPerBatch;
    }
  }

  std::int64_t pulses() const { return pulses_; }
  std::uintmax_t log_bytes() const { return std::filesystem::file_size(path().string() + "-wal"); }

  /// Waits until the open file has grown to `bytes`.
  bool file_reaches(std::uintmax_t bytes) const {
    return eventually([&] { return std::filesystem::file_size(path()) >= bytes; });
  }

 private:
  std::mt19937_64 random_{1};
  std::uniform_int_distribution<std::int64_t> anywhere_{0, 1'000'000'000'000'000'000};
  std::int64_t pulses_ = 0;
};

TEST_F(ArchiveLog, IsCarriedOverWhileTheArchiveIsOpenAndBeginsAnew) {
  const auto archive = open();
  ASSERT_TRUE(archive->submit(start_of("run")));
  write_long_log(*archive);
  EXPECT_TRUE(file_reaches(kMiB));

  write_long_log(*archive);
  write_long_log(*archive);
  // Without a restart from its beginning the log would grow further.
  EXPECT_LT(log_bytes(), 600 * kMiB);
  EXPECT_EQ(count("pulse"), pulses());
  EXPECT_EQ(text("PRAGMA integrity_check"), "ok");
  ASSERT_TRUE(archive->close());
  EXPECT_EQ(count("pulse"), pulses());
}

TEST_F(ArchiveLog, ItsPagesGoToTheDiskAFewAtATime) {
  const auto archive = open();
  ASSERT_TRUE(archive->submit(start_of("run")));
  const int before = times_brought_to_the_disk;
  write_long_log(*archive);
  ASSERT_TRUE(file_reaches(kMiB));
  ASSERT_TRUE(archive->close());

  // Some thousand pages are synced, a few dozen at a time.
  EXPECT_GT(times_brought_to_the_disk - before, 10);
}

TEST_F(ArchiveLog, GrowsAsLongAsAReaderNeedsItAndIsCarriedOverAfterwards) {
  const auto archive = open();
  commit(*archive, start_of("run"));
  {
    SQLite::Database slow = reader();
    slow.exec("BEGIN");
    EXPECT_EQ(slow.execAndGet("SELECT count(*) FROM pulse").getInt64(), 0);
    write_long_log(*archive);
    EXPECT_EQ(slow.execAndGet("SELECT count(*) FROM pulse").getInt64(), 0);
    EXPECT_LT(std::filesystem::file_size(path()), kMiB);
    EXPECT_GT(archive->statistics().log_mib, 128.0);
  }
  write_long_log(*archive);

  EXPECT_TRUE(file_reaches(kMiB));
  EXPECT_EQ(count("pulse"), pulses());
  EXPECT_EQ(text("PRAGMA integrity_check"), "ok");
}

}  // namespace
}  // namespace spindrift
