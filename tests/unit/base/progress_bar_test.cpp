#include "services/base/progress_bar.h"

#include <fcntl.h>
#include <pty.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <functional>
#include <string>
#include <system_error>

#include "tests/support/matchers.h"

namespace spindrift::progress_bar_test {

/// Returns what `work` writes to standard error when that is `descriptor`, read from `reading`.
std::string standard_error_of(int descriptor, int reading, const std::function<void()>& work) {
  std::fflush(stderr);
  const int kept = dup(STDERR_FILENO);
  dup2(descriptor, STDERR_FILENO);
  work();
  std::fflush(stderr);
  dup2(kept, STDERR_FILENO);
  close(kept);
  close(descriptor);
  fcntl(reading, F_SETFL, O_NONBLOCK);
  std::string text;
  std::array<char, 4096> buffer{};
  for (ssize_t n = 0; (n = read(reading, buffer.data(), buffer.size())) > 0;) {
    text.append(buffer.data(), static_cast<std::size_t>(n));
  }
  close(reading);
  return text;
}

std::string shown_on_a_terminal(const std::function<void()>& work) {
  int ours = 0;
  int theirs = 0;
  if (openpty(&ours, &theirs, nullptr, nullptr, nullptr) != 0) {
    throw std::system_error{errno, std::generic_category(), "openpty"};
  }
  return standard_error_of(theirs, ours, work);
}

TEST(ProgressBar, ShowsHowFarItIsOnATerminalAndLeavesTheLineClean) {
  const std::string text = shown_on_a_terminal([] {
    ProgressBar bar{"processing", 200};
    bar.advance_to(50);
  });
  EXPECT_THAT(text, HasSubstr("processing [#######-----------------------]  25 %"));
  EXPECT_THAT(text, EndsWith("\r\x1b[K"));
}

TEST(ProgressBar, DrawsSeldom) {
  std::chrono::duration<double> took{};
  const std::string text = shown_on_a_terminal([&took] {
    const auto start = std::chrono::steady_clock::now();
    ProgressBar bar{"processing", 10000};
    for (std::uint64_t i = 0; i < 10000; ++i) {
      bar.advance_to(i);
    }
    took = std::chrono::steady_clock::now() - start;
  });
  const auto drawn = std::ranges::count(text, '%');
  EXPECT_GE(drawn, 1);
  EXPECT_LE(static_cast<double>(drawn), 1.0 + 10.0 * took.count());
}

TEST(ProgressBar, IsSilentInAPipe) {
  std::array<int, 2> ends{};
  ASSERT_EQ(pipe(ends.data()), 0);
  EXPECT_EQ(standard_error_of(ends[1], ends[0],
                              [] {
                                ProgressBar bar{"processing", 200};
                                bar.advance_to(50);
                              }),
            "");
}

TEST(ProgressBar, IsSilentWhereThereIsNothingToDo) {
  EXPECT_EQ(shown_on_a_terminal([] {
              ProgressBar bar{"processing", 0};
              bar.advance_to(0);
            }),
            "");
}

}  // namespace spindrift::progress_bar_test
