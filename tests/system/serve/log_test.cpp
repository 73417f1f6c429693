#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <string>
#include <utility>

#include "tests/support/archive_rows.h"
#include "tests/support/bus_fixture.h"
#include "tests/support/matchers.h"
#include "tests/support/on_bus.h"
#include "tests/support/program.h"
#include "tests/support/recorded_files.h"
#include "tests/support/temporary_folder.h"

namespace spindrift::serve_log_test {

/// Holds a named pipe and its reader.
class Pipe {
 public:
  Pipe() : path_{(folder_.path() / "pipe").string()} {
    EXPECT_EQ(mkfifo(path_.c_str(), 0600), 0);
    reader_ = open(path_.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  }
  ~Pipe() { close(reader_); }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  const std::string& path() const { return path_; }

  void fill() const {
    const std::array<char, 4096> some{};
    while (write(reader_, some.data(), some.size()) > 0) {
    }
  }

  /// Closes the reader; call this once the program has opened the pipe.
  void lose_reader() { close(std::exchange(reader_, -1)); }

 private:
  TemporaryFolder folder_;
  std::string path_;
  int reader_ = -1;
};

/// Runs a service with these files for its streams; empty for the default.
class Listening {
 public:
  Listening(const std::string& out, const std::string& log)
      : program_{on(bus_, {"serve", "--mission", mission(), "--db", db()}), 0, out, log} {}

  Program& program() { return program_; }
  std::filesystem::path db() const { return folder_.path() / "served.db"; }

  /// Replays a whole pass.
  /// @return Exit status of `replay`.
  int replay() const {
    return ended(on(bus_, {"replay", "--mission", mission(), "--telemetry", kPasses / "nominal",
                           "--speed", "0"}))
        .status;
  }

  int stop() {
    program_.signal(SIGTERM);
    return program_.exit_status();
  }

  std::int64_t stored() const { return count_rows(db(), "pulse"); }
  std::int64_t finished_runs() const {
    return count_rows(db(), "run WHERE finished_utc IS NOT NULL");
  }

 private:
  static std::string mission() { return (kPasses / "nominal" / "mission.toml").string(); }
  TemporaryFolder folder_;
  bus::BusConfig bus_ = bus_of_its_own();
  Program program_;
};

TEST(ServeLog, HoldsNothingUpWhenNobodyReadsIt) {
  const Pipe pipe;
  pipe.fill();
  Listening service{"", pipe.path()};
  ASSERT_EQ(service.replay(), 0);
  EXPECT_EQ(service.stop(), 0);
  EXPECT_EQ(service.stored(), 3600);
  EXPECT_THAT(service.program().out(), HasSubstr("3600 edges"));
}

TEST(ServeLog, EndsNothingWhenItsReaderIsGone) {
  Pipe pipe;
  Listening service{"", pipe.path()};
  ASSERT_EQ(service.replay(), 0);
  pipe.lose_reader();
  EXPECT_EQ(service.stop(), 0);
  EXPECT_EQ(service.stored(), 3600);
}

TEST(ServeLog, IsNotWrittenIntoAFileWhenItsStreamIsClosed) {
  const TemporaryFolder folder;
  const auto db = folder.path() / "processed.db";
  const std::string command = "'" + spindrift_program().string() + "' process --mission '" +
                              (kPasses / "nominal" / "mission.toml").string() + "' --telemetry '" +
                              (kPasses / "nominal").string() + "' --db '" + db.string() +
                              "' > /dev/null 2>&-";
  EXPECT_EQ(std::system(command.c_str()), 0);
  for (const auto& file : std::filesystem::directory_iterator{folder.path()}) {
    EXPECT_EQ(text_of(file.path().string()).find("Z info "), std::string::npos) << file.path();
  }
}

TEST(ServeResults, AreAnErrorOfTheEndWhenTheirReaderIsGone) {
  Pipe pipe;
  Listening service{pipe.path(), ""};
  ASSERT_TRUE(service.program().says("ready"));
  pipe.lose_reader();
  EXPECT_EQ(service.stop(), 1);
  EXPECT_THAT(service.program().log(), HasSubstr("standard output: Broken pipe"));
  EXPECT_EQ(service.finished_runs(), 1);
}

TEST(ServeResults, HoldNothingUpWhenNobodyReadsThemNorTheLog) {
  const Pipe pipe;
  pipe.fill();
  Listening service{pipe.path(), pipe.path()};
  ASSERT_EQ(service.replay(), 0);
  EXPECT_EQ(service.stop(), 1);
  EXPECT_EQ(service.stored(), 3600);
}

}  // namespace spindrift::serve_log_test
