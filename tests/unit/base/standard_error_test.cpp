#include "services/base/standard_error.h"

#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdio>
#include <sstream>
#include <string>
#include <thread>

#include "tests/support/matchers.h"

namespace spindrift::standard_error_test {

/// Replaces standard error by a pipe during its lifetime.
class Piped {
 public:
  Piped() : before_{dup(STDERR_FILENO)} {
    EXPECT_EQ(pipe(ends_.data()), 0);
    dup2(ends_[1], STDERR_FILENO);
    ::close(ends_[1]);
  }
  ~Piped() {
    restore();
    ::close(before_);
    ::close(ends_[0]);
  }
  Piped(const Piped&) = delete;
  Piped& operator=(const Piped&) = delete;
  Piped(Piped&&) = delete;
  Piped& operator=(Piped&&) = delete;

  void restore() const { dup2(before_, STDERR_FILENO); }

  /// Reads until all writers have closed the pipe.
  std::string read_all() const {
    std::string all;
    std::array<char, 4096> some{};
    for (ssize_t got = 0; (got = ::read(ends_[0], some.data(), some.size())) > 0;) {
      all.append(some.data(), static_cast<std::size_t>(got));
    }
    return all;
  }

 private:
  std::array<int, 2> ends_{};
  int before_;
};

TEST(StandardError, IsOutInOrderWhenClosed) {
  const Piped pipe;
  std::string expected;
  {
    StandardError standard_error;
    for (int i = 0; i < 1000; ++i) {
      const std::string line = "line " + std::to_string(i) + "\n";
      std::fputs(line.c_str(), stderr);
      expected += line;
    }
    std::fputs("without an end", stderr);
    EXPECT_TRUE(standard_error.close());
  }
  pipe.restore();
  EXPECT_EQ(pipe.read_all(), expected + "without an end");
}

TEST(StandardError, MakesNobodyWaitAndCountsWhatItDrops) {
  const Piped pipe;
  std::string read;
  constexpr int kLines = 30'000;
  const std::string line(99, 'x');
  {
    StandardError standard_error;
    for (int i = 0; i < kLines; ++i) {  // More than the pipe and the queue hold.
      std::fprintf(stderr, "%s\n", line.c_str());
    }
    std::thread reader{[&] { read = pipe.read_all(); }};
    EXPECT_TRUE(standard_error.close());
    pipe.restore();
    reader.join();
  }
  int kept = 0;
  int dropped = 0;
  std::istringstream lines{read};
  for (std::string got; std::getline(lines, got);) {
    if (got == line) {
      ++kept;
    } else {
      ASSERT_THAT(got, EndsWith(" messages were dropped here: nobody read them"));
      dropped += std::stoi(got);
    }
  }
  EXPECT_GT(kept, 1000);
  EXPECT_GT(dropped, 1000);
  EXPECT_EQ(kept + dropped, kLines);
}

TEST(StandardError, IsNotOutWhenNobodyReads) {
  // The test has a process of its own because the blocked thread uses the object forever.
  EXPECT_EXIT(
      {
        const Piped pipe;
        StandardError standard_error;
        for (int i = 0; i < 30'000; ++i) {
          std::fputs("nobody reads this\n", stderr);
        }
        ::_exit(standard_error.close() ? 0 : 7);
      },
      ::testing::ExitedWithCode(7), "");
}

TEST(StandardError, SurvivesAReaderWhoIsGone) {
  signal(SIGPIPE, SIG_IGN);
  StandardError standard_error;
  const int before = dup(STDERR_FILENO);
  std::array<int, 2> ends{};
  ASSERT_EQ(pipe(ends.data()), 0);
  dup2(ends[1], STDERR_FILENO);
  ::close(ends[0]);
  ::close(ends[1]);
  std::fputs("to nobody\n", stderr);
  EXPECT_TRUE(standard_error.close());
  dup2(before, STDERR_FILENO);
  ::close(before);
}

}  // namespace spindrift::standard_error_test
