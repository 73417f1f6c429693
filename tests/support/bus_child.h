/// @file
/// The program bus_foreign_writer as a child process: only another process is met over the network.

#pragma once

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <string>
#include <utility>

#include "services/bus/participant.h"
#include "tests/support/test_paths.h"

namespace spindrift {

/// "telemetry": writes `count` pulses, seq 0 on, and goes when all are acknowledged. "keys": each
/// of another spacecraft; "impossible": of a time that cannot be; "foreign": of another type of the
/// same name; "patient": waits a minute in each write that is held up. "weak": offers BEST_EFFORT
/// and VOLATILE, and stays until killed.
class ForeignWriter {
 public:
  ForeignWriter(const bus::BusConfig& bus, std::string kind, int count)
      : arguments_{foreign_writer_program().string(), std::to_string(bus.domain), bus.partition,
                   std::move(kind), std::to_string(count)} {
    std::array<char*, 6> argv{};
    for (std::size_t i = 0; i < arguments_.size(); ++i) {
      argv.at(i) = arguments_.at(i).data();
    }
    if (posix_spawn(&pid_, argv.front(), nullptr, nullptr, argv.data(), environ) != 0) {
      pid_ = 0;
    }
  }
  ~ForeignWriter() {
    if (pid_ > 0) {
      kill(pid_, SIGKILL);
      exit_status();
    }
  }
  ForeignWriter(const ForeignWriter&) = delete;
  ForeignWriter& operator=(const ForeignWriter&) = delete;
  ForeignWriter(ForeignWriter&&) = delete;
  ForeignWriter& operator=(ForeignWriter&&) = delete;

  pid_t pid() const { return pid_; }

  /// Waits for its end. @return -1 when it did not end by itself.
  int exit_status() {
    int status = 0;
    const bool ended = waitpid(std::exchange(pid_, 0), &status, 0) > 0 && WIFEXITED(status);
    return ended ? WEXITSTATUS(status) : -1;
  }

 private:
  std::array<std::string, 5> arguments_;
  pid_t pid_ = 0;
};

}  // namespace spindrift
