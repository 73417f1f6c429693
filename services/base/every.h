/// @file
/// Repeats work until its thread is told to stop.

#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <stop_token>

namespace spindrift {

/// Does the work at once, and again `period` after each completion. A stop request ends the wait.
template <class Work>
void every(std::chrono::milliseconds period, const std::stop_token& stop, const Work& work) {
  std::mutex mutex;
  std::condition_variable_any stopped;
  std::unique_lock lock{mutex};
  while (!stop.stop_requested()) {
    work();
    stopped.wait_for(lock, stop, period, [] { return false; });
  }
}

}  // namespace spindrift
