/// @file
/// Measures how long samples wait to be committed.

#pragma once

#include <chrono>
#include <cstdint>
#include <deque>

namespace spindrift {

/// Measures the age of the oldest sample that is not committed, at the times when it is asked.
class BacklogWatch {
 public:
  using Instant = std::chrono::steady_clock::time_point;

  /// @param come Number of all samples so far.
  /// @param committed Number of committed samples.
  /// @return Age of the oldest sample that is not committed, s, counted from the call that first
  /// saw it.
  double see(Instant now, std::uint64_t come, std::uint64_t committed) {
    if (looks_.empty() || looks_.back().come != come) {
      looks_.push_back({.at = now, .come = come});
    }
    while (!looks_.empty() && looks_.front().come <= committed) {
      looks_.pop_front();
    }
    return looks_.empty() ? 0.0 : std::chrono::duration<double>{now - looks_.front().at}.count();
  }

 private:
  struct Look {
    Instant at;
    std::uint64_t come;
  };
  std::deque<Look> looks_;  ///< Calls whose samples are not all committed.
};

}  // namespace spindrift
