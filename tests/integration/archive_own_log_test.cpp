// An archive and the write-ahead log beside it: left by a killed program, of another file, or
// emptied by another program.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "tests/integration/archive_fixture.h"
#include "tests/support/matchers.h"

namespace spindrift::archive_own_log_test {

using testing::batch_of;
using ::testing::HasSubstr;
using testing::pulse_at;
using testing::start_of;
using testing::with_pulses;

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream file{path, std::ios::binary};
  return {std::istreambuf_iterator<char>{file}, {}};
}

class ArchiveOwnLog : public testing::ArchiveFixture {
 protected:
  std::filesystem::path log() const { return path().string() + "-wal"; }
  std::filesystem::path killed() const { return directory() / "killed.db"; }

  void add(Archive& archive, int pulses) {
    for (int i = 0; i < pulses; ++i) {
      commit(archive, with_pulses(batch_of("run-1"), {pulse_at(++last_tai_ns_)}));
    }
  }

  /// Copies the open archive as a kill would leave it.
  void leave_as_killed() const {
    for (const std::string suffix : {"", "-wal"}) {
      std::filesystem::copy_file(path().string() + suffix, killed().string() + suffix,
                                 std::filesystem::copy_options::overwrite_existing);
    }
  }

  std::int64_t last_tai_ns_ = 0;
};

TEST_F(ArchiveOwnLog, ThatAKillLeftIsCarriedOverHoweverOftenItIsKilled) {
  commit(*open(), start_of("run-1"));
  for (int kills = 0; kills < 5; ++kills) {
    const auto archive = open();
    leave_as_killed();
    ASSERT_TRUE(Archive::open(killed(), {})) << "killed before anything was stored";
    add(*archive, 3);
    leave_as_killed();
    if (kills % 2 == 0) {  // The next program finds the log of the one that was killed.
      ASSERT_TRUE(archive->close());
      std::filesystem::rename(killed(), path());
      std::filesystem::rename(killed().string() + "-wal", log());
    }
  }
  ASSERT_TRUE(open()->close());
  EXPECT_EQ(count("pulse"), 15);
  EXPECT_EQ(text("PRAGMA integrity_check"), "ok");
}

TEST_F(ArchiveOwnLog, IsItsOwnAfterItHasBegunAnew) {
  const auto archive = open();
  commit(*archive, start_of("run-1"));
  for (int rounds = 0; rounds < 3; ++rounds) {
    add(*archive, 2);
    SQLite::Database other{path().string(), SQLite::OPEN_READWRITE, 5000};
    EXPECT_EQ(other.execAndGet("PRAGMA wal_checkpoint(TRUNCATE)").getInt(), 0);
    add(*archive, 2);
    leave_as_killed();
    ASSERT_TRUE(Archive::open(killed(), {}).value()->close()) << rounds;
  }
}

TEST_F(ArchiveOwnLog, OfAnotherFileIsRefusedAndBothAreLeftUntouched) {
  for (const bool is_new : {true, false}) {  // A log with, and one without, the first pages.
    const auto archive = open();
    if (is_new) {
      commit(*archive, start_of("run-1"));
    }
    add(*archive, 3);
    leave_as_killed();
    ASSERT_TRUE(archive->close());
    const std::filesystem::path other = directory() / "other.db";
    std::filesystem::remove(other);
    ASSERT_TRUE(Archive::open(other, {}).value()->close());
    std::filesystem::copy_file(other, killed(), std::filesystem::copy_options::overwrite_existing);
    const std::array before = {bytes_of(killed()), bytes_of(killed().string() + "-wal")};

    EXPECT_THAT(Archive::open(killed(), {}), IsRefused(ErrorCode::InvalidConfiguration,
                                                       HasSubstr("is the log of another file")));
    EXPECT_EQ(bytes_of(killed()), before[0]);
    EXPECT_EQ(bytes_of(killed().string() + "-wal"), before[1]);
    std::filesystem::remove(killed().string() + "-wal");
    EXPECT_TRUE(Archive::open(killed(), {}));
  }
}

TEST_F(ArchiveOwnLog, AnotherProgramMayShrinkTheFileUnderLoad) {
  const std::string filler =
      "CREATE TABLE filler AS WITH RECURSIVE n(i) AS (VALUES (1) UNION ALL SELECT i + 1 FROM n"
      " WHERE i < 2000) SELECT i, randomblob(2000) FROM n";
  const auto archive = open();
  commit(*archive, start_of("run-1"));
  SQLite::Database other{path().string(), SQLite::OPEN_READWRITE, 5000};
  for (int rounds = 0; rounds < 3; ++rounds) {
    other.exec(filler);
    add(*archive, 2);
    other.exec("PRAGMA wal_checkpoint(TRUNCATE)");
    add(*archive, 2);
    const auto before = std::filesystem::file_size(path());
    other.exec("DROP TABLE filler; VACUUM");
    add(*archive, 2);
    other.exec("PRAGMA wal_checkpoint(TRUNCATE)");
    EXPECT_LT(std::filesystem::file_size(path()), before / 2);
    add(*archive, 2);
    // Between two looks at the file it grows, and the database shrinks again in the log.
    other.exec(filler);
    add(*archive, 2);
    other.exec("PRAGMA wal_checkpoint(TRUNCATE)");
    other.exec("DROP TABLE filler; VACUUM");
    add(*archive, 2);
  }
  EXPECT_FALSE(archive->statistics().failure);
  ASSERT_TRUE(archive->close());
  EXPECT_EQ(count("pulse"), 36);
  EXPECT_EQ(text("PRAGMA integrity_check"), "ok");
}

}  // namespace spindrift::archive_own_log_test
