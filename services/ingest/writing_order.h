/// @file
/// Samples of several topics in the order in which they were written. DDS keeps it within a topic
/// only.

#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "services/telemetry/sample_batch.h"

namespace spindrift {

/// What was written before a sample has come before it, unless it came of another topic, which is
/// looked at a moment later: so a sample waits for the next look at all topics. Samples of a
/// session that is heard first may be its last minutes, which come topic by topic: they wait for
/// kLastMinutes.
class WritingOrder {
 public:
  using Instant = std::chrono::steady_clock::time_point;

  static constexpr std::chrono::milliseconds kLastMinutes{200};
  /// More do not wait for that.
  static constexpr std::size_t kMost = 16'384;

  /// @param taken What all topics had; `arrival`: when it was written, by the writer's clock.
  /// @return what need not wait any longer. Of one kind in the order in which it was taken.
  SampleBatch pass_on(SampleBatch taken, Instant now);

  /// What waits still.
  SampleBatch rest();

  /// Something waits for the next look, which is to follow at once, or at `wait_until`.
  bool holds_some() const { return !is_empty(held_); }
  std::optional<Instant> wait_until() const { return until_; }

 private:
  bool is_new(const Origin& origin);

  SampleBatch held_;
  std::optional<Instant> until_;  ///< What is held waits for the last minutes of a session.
  std::set<std::pair<std::string, std::uint64_t>> heard_;  ///< Sources and sessions.
  std::optional<std::pair<std::string, std::uint64_t>> last_;
};

}  // namespace spindrift
