/// @file
/// Runs bus_foreign_writer as a child process: DDS participants meet over the network only across
/// processes.

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

/// Starts a child process that writes pulses, by `kind`: "telemetry" writes `count` pulses from seq
/// 0 on and exits once all are acknowledged; "keys" does so with another spacecraft each;
/// "impossible" with impossible times; "foreign" with another type of the same name; "patient"
/// waits up to a minute in each blocked write. "weak" offers BEST_EFFORT and VOLATILE and stays
/// until it is killed.
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

  pid_t pid() const { return pid_; }

  /// Waits until the child exits.
  /// @return Exit status, or -1 if the child was killed.
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
