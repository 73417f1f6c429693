/// @file
/// SIGINT, SIGTERM and SIGHUP as an ordinary call on an ordinary thread.

#pragma once

#include <csignal>
#include <functional>
#include <thread>

namespace spindrift {

/// Construct before any other thread: those started later must not see the signals either.
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
  /// After this the stop has run.
  void join();

 private:
  sigset_t signals_{};
  std::thread thread_;
};

}  // namespace spindrift
