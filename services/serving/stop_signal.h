/// @file
/// Turns SIGINT, SIGTERM and SIGHUP into an ordinary call on an ordinary thread.

#pragma once

#include <csignal>
#include <functional>
#include <thread>

namespace spindrift {

/// Blocks the signals and waits for them. Must be constructed before any other thread starts, so
/// that those threads block the signals too.
class StopSignal {
 public:
  StopSignal();
  ~StopSignal();
  StopSignal(const StopSignal&) = delete;
  StopSignal& operator=(const StopSignal&) = delete;
  StopSignal(StopSignal&&) = delete;
  StopSignal& operator=(StopSignal&&) = delete;

  /// Runs `stop` once, on a thread of its own, when a signal arrives or `raise` is called.
  void on_stop(std::function<void()> stop);
  static void raise();
  void join();

 private:
  sigset_t signals_{};
  std::thread thread_;
};

}  // namespace spindrift
