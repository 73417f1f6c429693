/// @file
/// Restores the order of writing across topics, which DDS keeps within a topic only.

#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "services/telemetry/sample_batch.h"

namespace spindrift {

/// Restores the order of writing. Samples written before a given one have arrived before it, except
/// on another topic, which is read a moment later; so each sample waits for the next reading of all
/// topics. The first samples of a new session may be its last minutes sent again, which come topic
/// by topic: they wait for kLastMinutes.
class WritingOrder {
 public:
  using Instant = std::chrono::steady_clock::time_point;

  static constexpr std::chrono::milliseconds kLastMinutes{200};
  /// At most this many samples wait for kLastMinutes.
  static constexpr std::size_t kMost = 16'384;

  /// @param taken Samples of all topics; their places are the times of writing. @return Samples
  /// that need not wait any longer.
  SampleBatch pass_on(SampleBatch taken, Instant now);

  SampleBatch rest();

  /// Returns whether samples wait for the next reading, due at once or at `wait_until`.
  bool holds_some() const { return !is_empty(held_); }
  std::optional<Instant> wait_until() const { return until_; }

 private:
  bool is_new(const Origin& origin);

  SampleBatch held_;
  std::optional<Instant> until_;  ///< Set while samples of a new session wait.
  std::set<std::pair<std::string, std::uint64_t>> heard_;  ///< Sources and sessions heard.
  std::optional<std::pair<std::string, std::uint64_t>> last_;
};

}  // namespace spindrift
