/// @file
/// Runs the real program as a child process with access to its output and exit status.

#pragma once

#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "tests/support/temporary_folder.h"
#include "tests/support/test_paths.h"
#include "tests/support/text_of.h"

namespace spindrift {

class Program {
 public:
  /// Starts spindrift.
  /// @param largest_file_kib Largest file that it may write, to simulate a full disk; 0 for no
  /// limit.
  /// @param out File for standard output; when empty, out() returns that output.
  /// @param log File for standard error; when empty, log() returns that output.
  explicit Program(std::vector<std::string> arguments, int largest_file_kib = 0,
                   const std::string& out = "", const std::string& log = "")
      : Program{spindrift_program(), std::move(arguments), largest_file_kib, out, log} {}

  /// Starts another program.
  Program(const std::filesystem::path& program, std::vector<std::string> arguments,
          int largest_file_kib = 0, const std::string& out = "", const std::string& log = "")
      : out_path_{out.empty() ? (folder_.path() / "out").string() : out},
        log_path_{log.empty() ? (folder_.path() / "log").string() : log} {
    arguments.insert(arguments.begin(), {program.string()});
    if (largest_file_kib > 0) {
      const std::string limit = "ulimit -f " + std::to_string(largest_file_kib);
      arguments.insert(arguments.begin(), {"/bin/bash", "-c", limit + "; exec \"$@\"", "bash"});
    }
    std::vector<char*> argv;
    for (std::string& argument : arguments) {
      argv.push_back(argument.data());
    }
    argv.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    const int flags = O_WRONLY | O_CREAT | O_TRUNC;
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, out_path_.c_str(), flags, 0600);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, log_path_.c_str(), flags, 0600);
    if (posix_spawn(&pid_, argv.front(), &actions, nullptr, argv.data(), environ) != 0) {
      pid_ = 0;
    }
    posix_spawn_file_actions_destroy(&actions);
  }
  ~Program() {
    if (pid_ > 0) {
      signal(SIGKILL);
      exit_status();
    }
  }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  void signal(int number) const { kill(pid_, number); }

  /// Waits until the program ends.
  /// @return Exit status, or -1 if it was killed.
  int exit_status() {
    int status = 0;
    rusage used{};
    const bool ended = wait4(std::exchange(pid_, 0), &status, 0, &used) > 0 && WIFEXITED(status);
    peak_kib_ = used.ru_maxrss;
    return ended ? WEXITSTATUS(status) : -1;
  }

  /// Waits until the program has printed `words` on standard error.
  /// @return False if it does not.
  bool says(const std::string& words) const {
    using namespace std::chrono_literals;
    for (int tries = 0; tries < 6000; ++tries) {
      if (log().find(words) != std::string::npos) {
        return true;
      }
      std::this_thread::sleep_for(10ms);
    }
    return false;
  }

  /// Returns the memory that the running program has for itself, without what stands in files.
  long memory_kib() const {
    const std::string status = text_of("/proc/" + std::to_string(pid_) + "/status");
    const std::string name = "RssAnon:";
    const std::size_t at = status.find(name);
    return at == std::string::npos ? 0 : std::stol(status.substr(at + name.size()));
  }

  /// Returns the peak memory; valid once exit_status() has returned.
  long peak_kib() const { return peak_kib_; }

  std::string out() const { return text_of(out_path_); }
  std::string log() const { return text_of(log_path_); }

 private:
  TemporaryFolder folder_;
  std::string out_path_;
  std::string log_path_;
  pid_t pid_ = 0;
  long peak_kib_ = 0;
};

}  // namespace spindrift
