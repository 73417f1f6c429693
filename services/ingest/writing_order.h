/// @file
/// Restores the order of writing across topics, which DDS keeps within a topic only.

#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "services/telemetry/sample_batch.h"

namespace spindrift {

/// Restores the order of writing. Samples written before a given one have arrived before it, except
/// on another topic, which is read a moment later; so each sample waits for the next reading of all
/// topics. The first samples of a new session may be its last minutes sent again, which come topic
/// by topic: they wait for kLastMinutes. After a restart each topic sends again what is stored, and
/// what is new behind it; the new samples wait until all topics have come that far.
class WritingOrder {
 public:
  using Instant = std::chrono::steady_clock::time_point;

  /// @param stored The highest seq of each session and kind that was stored before a restart.
  explicit WritingOrder(const LastOrigins& stored = {});

  static constexpr std::chrono::milliseconds kLastMinutes{200};
  /// A topic that does not send again what is stored is not waited for longer.
  static constexpr std::chrono::seconds kLongest{5};
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
  using Session = std::pair<std::string, std::uint64_t>;

  template <class Value>
  bool is_stored(const TelemetrySample<Value>& sample);
  void begin_waiting(const TelemetrySamples& taken, Instant now);
  void catch_up(TelemetrySamples& taken, TelemetrySamples& stored);
  bool is_behind() const;
  bool is_new(const Origin& origin);

  SampleBatch held_;
  std::optional<Instant> until_;  ///< Set while samples of a new session wait.
  Instant longest_;               ///< Limit of `until_`.
  std::set<Session> heard_;       ///< Sources and sessions heard.
  std::optional<Session> last_;
  /// The last stored seq of each session and kind.
  std::map<std::pair<Session, std::size_t>, std::uint64_t> stored_;
  /// Those of `stored_` that have not come again.
  std::set<std::pair<Session, std::size_t>> behind_;
};

}  // namespace spindrift
