#include <SQLiteCpp/Exception.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "services/archive/archive.h"
#include "services/archive/schema.h"
#include "tests/integration/archive_fixture.h"
#include "tests/support/matchers.h"
#include "tests/support/text_of.h"

namespace spindrift::archive_file_test {

using testing::start_of;

constexpr ErrorCode kBad = ErrorCode::InvalidConfiguration;

std::ptrdiff_t files_in(const std::filesystem::path& directory) {
  return std::distance(std::filesystem::directory_iterator{directory}, {});
}

class ArchiveFile : public testing::ArchiveFixture {
 protected:
  /// Expects writers and readers to be refused, and the file to stay as it is, alone in its folder.
  template <class Message>
  void expect_refused_and_untouched(const Message& message) const {
    const std::string before = text_of(path());
    EXPECT_THAT(Archive::open(path(), {}), IsRefused(kBad, message));
    EXPECT_THAT(open_for_reading(path()), IsRefused(kBad, message));
    EXPECT_EQ(text_of(path()), before);
    EXPECT_EQ(files_in(directory()), 1);
  }
};

TEST_F(ArchiveFile, SecondWriterIsRefusedWithTheHolderNamed) {
  const auto archive = open();
  const std::filesystem::path link = directory() / "link.db";
  std::filesystem::create_symlink(path(), link);

  for (const std::filesystem::path& name : {path(), link}) {
    EXPECT_THAT(Archive::open(name, {}),
                IsRefused(ErrorCode::Unavailable,
                          HasSubstr(fmt::format("is being written by pid {} (", getpid()))));
  }
}

TEST_F(ArchiveFile, LockOfAKilledWriterBlocksNobody) {
  std::array<int, 2> ready{};
  ASSERT_EQ(pipe(ready.data()), 0);
  const pid_t child = fork();
  if (child == 0) {
    const auto archive = open();
    static_cast<void>(write(ready[1], "!", 1));
    pause();
    _exit(0);
  }
  close(ready[1]);
  char byte = 0;
  ASSERT_EQ(read(ready[0], &byte, 1), 1);
  close(ready[0]);

  EXPECT_THAT(Archive::open(path(), {}),
              IsRefused(ErrorCode::Unavailable, HasSubstr("pid " + std::to_string(child))));
  ASSERT_EQ(kill(child, SIGKILL), 0);
  ASSERT_EQ(waitpid(child, nullptr, 0), child);
  EXPECT_TRUE(std::filesystem::exists(path().string() + ".lock"));
  EXPECT_TRUE(Archive::open(path(), {}));
}

TEST_F(ArchiveFile, FileThatIsNotSqliteIsRefusedAndLeftUntouched) {
  for (const std::string& content :
       {std::string{"t_tai_ns,channel\n1,sun1\n"}, std::string{"SQLite format 3\0", 16},
        std::string(4096, 'x')}) {
    std::ofstream{path(), std::ios::binary | std::ios::trunc} << content;
    expect_refused_and_untouched(HasSubstr("is not an archive"));
  }
}

TEST_F(ArchiveFile, DatabaseOfAnotherProgramIsRefusedAndLeftUntouched) {
  SQLite::Database{path().string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE}.exec(
      "PRAGMA application_id = 42; PRAGMA journal_mode = WAL; CREATE TABLE pulse (x)");
  expect_refused_and_untouched(HasSubstr("application_id 42"));
}

TEST_F(ArchiveFile, ArchiveWithOtherTablesIsRefusedByWritersAndReadersAndLeftUntouched) {
  ASSERT_TRUE(open()->close());
  std::filesystem::remove(path().string() + ".lock");
  for (const std::string version : {"12", "99", "0", "-1", "-2147483648"}) {
    SQLite::Database{path().string(), SQLite::OPEN_READWRITE}.exec("PRAGMA user_version = " +
                                                                   version);
    expect_refused_and_untouched(AllOf(HasSubstr("schema version " + version + ", this program"),
                                       HasSubstr("process its telemetry again into a new one")));
  }
}

TEST_F(ArchiveFile, EmptyFileBecomesAnArchive) {
  std::ofstream{path()}.close();
  ASSERT_TRUE(open()->close());
  EXPECT_EQ(number("PRAGMA application_id"), kArchiveApplicationId);
}

TEST_F(ArchiveFile, TablesOfEveryEdgeTakeNoOtherNamesThanThoseOfTheContract) {
  ASSERT_TRUE(open()->close());
  SQLite::Database raw{path().string(), SQLite::OPEN_READWRITE};
  raw.exec("INSERT INTO spacecraft VALUES ('A', 'A', 'spin')");
  const std::string run =
      "INSERT INTO run VALUES ('r', 'A', 'live', '', '', '', '', NULL, NULL, NULL, '', NULL, 0, 0, "
      "0, NULL)";
  raw.exec(run);
  const auto takes = [&raw](const std::string& values) {
    return raw.tryExec("INSERT INTO " + values) == SQLite::OK;
  };
  for (const char* channel :
       {"sun1", "sun2", "north_in", "north_out", "south_in", "south_out", "Sun1", "", "sun"}) {
    const bool known = pulse_channel_from(channel).has_value();
    EXPECT_EQ(takes(fmt::format("pulse VALUES ('A', 1, '{}', '', 0, 0, 0)", channel)), known);
    EXPECT_EQ(takes(fmt::format("pulse_use VALUES ('r', 'A', 1, '{}', 1, 1, NULL, 1, 1, 4100, 1)",
                                channel)),
              known);
  }
  for (const int number : {-1, 0, 5, 6}) {
    EXPECT_EQ(takes(fmt::format("batch_residual VALUES ('r', 1, 1, {}, 1, 1, 1)", number)),
              number >= 0 && number <= 5);
  }
  EXPECT_TRUE(
      takes("spin_measurement VALUES ('r', 1, 'mixed_azimuth', 1, 'deg', 1, 1, NULL, 1, 1)"));
  EXPECT_FALSE(takes("spin_measurement VALUES ('r', 1, 'azimuth', 1, 'deg', 1, 1, NULL, 1, 1)"));
  EXPECT_TRUE(
      takes("spin_fix VALUES ('r', 1, 1, 1, 1, 1, 1, 1, 1, 0, 1, NULL, NULL, 'AMBIGUOUS', 1, 1, 0, "
            "NULL)"));
  EXPECT_FALSE(takes(
      "spin_fix VALUES ('r', 2, 1, 1, 1, 1, 1, 1, 1, 0, 1, NULL, NULL, 'NONE', 1, 1, 0, NULL)"));
  EXPECT_TRUE(takes(
      "spin_estimate VALUES ('r', 1, 'batch', 1, 1, 1, 1, 1, 0, 1, 1, 1, 'OK', '[]', 'OK', NULL)"));
  EXPECT_FALSE(takes(
      "spin_estimate VALUES ('r', 2, 'batch', 1, 1, 1, 1, 1, 0, 1, 1, 1, 'GOOD', '[]', '', NULL)"));
  EXPECT_FALSE(takes(
      "spin_estimate VALUES ('r', 1, 'mode', 1, 1, 1, 1, 1, 0, 1, 1, 1, 'OK', '[]', 'OK', NULL)"));
}

TEST_F(ArchiveFile, NameThatSqliteTakesForSomethingElseIsRefused) {
  for (const char* name :
       {":memory:", "file:pass.db", "file:pass.db?mode=memory", "file::memory:"}) {
    const auto is_refused =
        IsRefused(kBad, HasSubstr("takes this name for something else than a file"));
    EXPECT_THAT(Archive::open(name, {}), is_refused);
    EXPECT_THAT(open_for_reading(name), is_refused);
    EXPECT_FALSE(std::filesystem::exists(name));
  }
}

/// Makes a folder read-only; root switches to another user, since permissions do not bind root.
class ReadOnlyFolder {
 public:
  explicit ReadOnlyFolder(std::filesystem::path folder) : folder_{std::move(folder)} {
    std::filesystem::permissions(folder_, std::filesystem::perms{0555});
    if (was_root_) {
      EXPECT_EQ(seteuid(kNobody), 0);
    }
  }
  ~ReadOnlyFolder() {
    if (was_root_) {
      EXPECT_EQ(seteuid(0), 0);
    }
    std::filesystem::permissions(folder_, std::filesystem::perms{0755});
  }
  ReadOnlyFolder(const ReadOnlyFolder&) = delete;
  ReadOnlyFolder& operator=(const ReadOnlyFolder&) = delete;

 private:
  static constexpr uid_t kNobody = 65534;
  std::filesystem::path folder_;
  bool was_root_ = geteuid() == 0;
};

std::string kind_in(const std::filesystem::path& archive) {
  const auto read = read_archive(archive, [](SQLite::Database& database) {
    return database.execAndGet("SELECT kind FROM spacecraft").getString();
  });
  return read ? *read : read.error().message;
}

TEST_F(ArchiveFile, IsReadInAFolderWhereNoFileMayBeMade) {
  store(start_of("run-1"));
  for (const bool empty_log : {false, true}) {
    if (empty_log) {
      std::ofstream{log_of(path())}.close();
    }
    const ReadOnlyFolder folder{directory()};
    EXPECT_EQ(kind_in(path()), "spin");
  }
}

TEST_F(ArchiveFile, WhoseLogCannotBeReadIsRefusedAndSaysWhatToDo) {
  const std::filesystem::path copy = directory() / "copy";
  std::filesystem::create_directory(copy);
  const auto archive = open();
  commit(*archive, start_of("run-1"));
  std::filesystem::copy(path(), copy / "pass.db");
  std::filesystem::copy(log_of(path()), log_of(copy / "pass.db"));
  std::filesystem::permissions(directory(), std::filesystem::perms{0755});
  const ReadOnlyFolder folder{copy};
  EXPECT_THAT(kind_in(copy / "pass.db"), HasSubstr("copy both to another folder, and read there"));
}

TEST_F(ArchiveFile, PathThatCannotBeThatOfAFileIsRefusedAndLeavesNoLock) {
  const std::filesystem::path folder = directory() / "folder";
  std::filesystem::create_directory(folder);
  std::ofstream{directory() / "file"}.close();
  const std::vector<std::pair<std::filesystem::path, std::string>> cases = {
      {"", "archive \"\": must be the path of a file"},
      {folder, "is a directory, must be a file"},
      {"/dev/null", "is not a regular file"},
      {directory() / "absent" / "pass.db", "there is no directory " + directory().string()},
      {directory() / "file" / "pass.db", "there is no directory " + directory().string()},
      {directory() / "absent/", "there is no directory " + directory().string()}};
  for (const auto& [bad, message] : cases) {
    EXPECT_THAT(Archive::open(bad, {}), IsRefused(kBad, HasSubstr(message))) << bad;
    EXPECT_FALSE(std::filesystem::exists(bad.string() + ".lock"));
  }
  EXPECT_EQ(files_in(directory()), 2);
  EXPECT_EQ(files_in(folder), 0);
}

TEST_F(ArchiveFile, RelativePathIsThatOfTheSameFile) {
  const auto archive = open();
  EXPECT_THAT(Archive::open(std::filesystem::relative(path()), {}),
              IsRefused(ErrorCode::Unavailable, HasSubstr("is being written by")));
}

TEST_F(ArchiveFile, FolderThatTakesNoFilesIsAnError) {
  EXPECT_THAT(Archive::open("/proc/pass.db", {}),
              IsRefused(kBad, HasSubstr("cannot lock /proc/pass.db.lock")));
}

TEST_F(ArchiveFile, ReaderSeesWhatIsCommittedAndCannotWrite) {
  const auto archive = open();
  commit(*archive, start_of("run-1"));

  SQLite::Database database = reader();
  EXPECT_EQ(database.execAndGet("SELECT count(*) FROM run").getInt(), 1);
  EXPECT_THROW(database.exec("DELETE FROM run"), SQLite::Exception);
}

/// Returns the type of the lock that SQLite holds on the file, as another process sees it.
short lock_of_sqlite(const std::filesystem::path& path) {
  constexpr off_t kSqliteSharedFirst = 0x40000002;
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-vararg): POSIX has no other open
  const int probe = ::open(path.c_str(), O_RDWR | O_CLOEXEC);
  struct flock wanted {};
  wanted.l_type = F_WRLCK;
  wanted.l_whence = SEEK_SET;
  wanted.l_start = kSqliteSharedFirst;
  wanted.l_len = 1;
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-vararg): nor another fcntl
  EXPECT_EQ(fcntl(probe, F_OFD_GETLK, &wanted), 0);
  ::close(probe);
  return wanted.l_type;
}

// If a process lost its lock, the sqlite3 of another process could delete the log under it.
TEST_F(ArchiveFile, LookingAtTheFileLeavesItsWriterTheLocks) {
  const auto archive = open();
  EXPECT_EQ(count("run"), 0);
  EXPECT_FALSE(Archive::open(path(), {}));
  EXPECT_EQ(lock_of_sqlite(path()), F_RDLCK);
}

TEST_F(ArchiveFile, SecondWriterIsRefusedWhateverNameItHasForTheFile) {
  const auto archive = open();
  for (const char* name : {"link.db", "another.db"}) {
    const std::filesystem::path other = directory() / name;
    std::filesystem::create_hard_link(path(), other);
    EXPECT_THAT(
        Archive::open(other, {}),
        IsRefused(ErrorCode::Unavailable, AllOf(HasSubstr("is being written under another name"),
                                                HasSubstr("by pid " + std::to_string(getpid())))));
  }
  EXPECT_EQ(lock_of_sqlite(path()), F_RDLCK);
}

}  // namespace spindrift::archive_file_test
