/// @file
/// Counts and converts the samples from the bus, and separates this service's samples from those of
/// others and from impossible ones.

#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "services/base/wall_clock.h"
#include "services/ingest/from_idl.h"
#include "services/ingest/rejection_limit.h"
#include "services/ingest/sequence_tracker.h"
#include "services/telemetry/sample_batch.h"

namespace spindrift {

struct SpacecraftCounts {
  std::uint64_t received = 0;
  std::uint64_t rejected = 0;  ///< Received samples that could not be true.
};
using CountsBySpacecraft = std::map<std::string, SpacecraftCounts, std::less<>>;

/// Counts and converts samples. May be used by any thread. Memory is bounded.
class Arrivals {
 public:
  /// @param spacecraft Spacecraft that have a mission here.
  /// @param stored Origins stored before a restart; their gaps are not counted again.
  Arrivals(std::set<std::string, std::less<>> spacecraft, const LastOrigins& stored);

  bool is_ours(std::string_view spacecraft) const { return ours_.contains(spacecraft); }

  /// Puts a sample of this service's spacecraft into `batch`, or the reason why it is rejected. A
  /// valid sample is only counted by `count`.
  template <class Value>
  void accept(const bus::MessageOf<Value>& message, std::int64_t written_ns, SampleBatch& batch) {
    if (auto sample = from_idl<Value>(message)) {
      sample->place = {written_ns};
      batch.samples.template of<Value>().push_back(*std::move(sample));
    } else {
      const std::lock_guard lock{mutex_};
      track<Value>(message, sample, batch);
    }
  }

  /// Counts the samples of this service's spacecraft.
  /// @return All counts of the sources with samples counted since the last call.
  std::map<std::string, SequenceCounts> count(const TelemetrySamples& samples);

  /// Counts a sample of another spacecraft. `take_rest` returns these counts.
  template <class Value>
  void take_other(const bus::MessageOf<Value>& message) {
    const auto sample = from_idl<Value>(message);
    const std::lock_guard lock{mutex_};
    if (track(message, sample, rest_)) {
      ++entry_of(rest_.others, sample->spacecraft).second;
    }
  }

  /// Returns the counts and rejections that belong to no batch of samples.
  /// @param now Wall clock, as in RejectionLimit.
  SampleBatch take_rest(TaiTime now);

  std::map<std::string, SequenceCounts> by_source() const;
  CountsBySpacecraft by_spacecraft() const;

 private:
  /// Records the origin of a sample and rejects one that cannot be true. `mutex_` must be held.
  /// @return Whether the sample can be true.
  template <class Value>
  bool track(const bus::MessageOf<Value>& message, const Expected<TelemetrySample<Value>>& sample,
             SampleBatch& batch) {
    const Origin origin = sample ? sample->origin : origin_from_idl(message);
    tracker_.record(origin, message.spacecraft, kTelemetryKind<Value>);
    if (sample) {
      return true;
    }
    if (const auto of = by_spacecraft_.find(message.spacecraft); of != by_spacecraft_.end()) {
      ++of->second.received;
      ++of->second.rejected;
    }
    if (auto rejected = limit_.pass(rejected_from_idl(origin, sample.error().message), tai_now())) {
      batch.rejected.push_back(*std::move(rejected));
    }
    return false;
  }

  const std::set<std::string, std::less<>> ours_;

  mutable std::mutex mutex_;  // Guards the four members below.
  SequenceTracker tracker_;
  RejectionLimit limit_;
  SampleBatch rest_;
  CountsBySpacecraft by_spacecraft_;
};

}  // namespace spindrift
