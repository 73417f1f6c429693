/// @file
/// How long samples wait to be committed.

#pragma once

#include <chrono>
#include <cstdint>
#include <deque>

namespace spindrift {

/// Looked at now and then, at times that are given.
class BacklogWatch {
 public:
  using Instant = std::chrono::steady_clock::time_point;

  /// @param come All samples so far. @param committed Of those.
  /// @return the age of the oldest that is not, as far as was looked.
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
  std::deque<Look> looks_;  ///< In which some are not committed.
};

}  // namespace spindrift
