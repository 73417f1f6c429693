/// @file
/// Decides when to try again what fails.

#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <optional>

namespace spindrift {

/// Waits a second after the first failure, and twice as long after each that follows, at most a
/// minute.
class BackOff {
 public:
  using Instant = std::chrono::steady_clock::time_point;
  static constexpr std::chrono::seconds kFirst{1};
  static constexpr std::chrono::seconds kMost{60};

  bool is_due(Instant now) const { return now >= next_; }

  void fail(Instant now) {
    ++failures_;
    since_ = since_.value_or(now);
    next_ = now + wait_;
    wait_ = std::min(2 * wait_, kMost);
  }
  void succeed() {
    since_.reset();
    next_ = {};
    wait_ = kFirst;
  }

  /// Returns how many tries have failed so far.
  std::int64_t failures() const { return failures_; }
  /// Returns for how long every try has failed; 0 when the last one has not.
  double failing_s(Instant now) const {
    return since_ ? std::chrono::duration<double>{now - *since_}.count() : 0.0;
  }

 private:
  std::int64_t failures_ = 0;
  std::optional<Instant> since_;
  Instant next_ = {};
  std::chrono::seconds wait_ = kFirst;
};

}  // namespace spindrift
