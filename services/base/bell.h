/// @file
/// Wakes a thread that otherwise looks only from time to time.

#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <stop_token>

namespace spindrift {

/// Any thread rings, one waits. A ring that comes while nobody waits ends the next wait.
class Bell {
 public:
  void ring() {
    {
      const std::lock_guard lock{mutex_};
      has_rung_ = true;
    }
    rung_.notify_one();
  }

  /// Waits for a ring, a stop request or the end of `longest`.
  void wait_for(std::chrono::milliseconds longest, const std::stop_token& stop) {
    std::unique_lock lock{mutex_};
    rung_.wait_for(lock, stop, longest, [this] { return has_rung_; });
    has_rung_ = false;
  }

 private:
  std::mutex mutex_;
  std::condition_variable_any rung_;
  bool has_rung_ = false;
};

}  // namespace spindrift
