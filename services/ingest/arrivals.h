/// @file
/// What arrives from the bus: counted, converted, and sorted into ours, others' and impossible.

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
#include "services/telemetry/last_origins.h"
#include "services/telemetry/sample_batch.h"

namespace spindrift {

/// How many samples came of one spacecraft.
struct SpacecraftCounts {
  std::uint64_t received = 0;
  std::uint64_t rejected = 0;  ///< Of those, they could not be true.
};
/// By name.
using CountsBySpacecraft = std::map<std::string, SpacecraftCounts, std::less<>>;

/// From any thread. Its memory is bounded whatever is sent.
class Arrivals {
 public:
  /// @param spacecraft That have a mission here. @param stored Before a restart: no gap is counted
  /// again.
  Arrivals(std::set<std::string, std::less<>> spacecraft, const LastOrigins& stored);

  bool is_ours(std::string_view spacecraft) const { return ours_.contains(spacecraft); }

  /// A sample of ours: its value, or why there is none, into `batch`. It is counted with `count`.
  template <class Value>
  void take(const bus::MessageOf<Value>& message, std::int64_t written_ns, SampleBatch& batch) {
    if (auto sample = from_idl<Value>(message)) {
      sample->arrival = written_ns;
      batch.samples.template of<Value>().push_back(*std::move(sample));
    } else {
      const std::lock_guard lock{mutex_};
      note<Value>(message, sample, batch);
    }
  }

  /// @return of the sources of which samples were counted since this was last asked, all counts.
  std::map<std::string, SequenceCounts> count(const TelemetrySamples& samples);

  /// A sample of another spacecraft: `take_rest` gives what is to be known of it.
  template <class Value>
  void take_other(const bus::MessageOf<Value>& message) {
    const auto sample = from_idl<Value>(message);
    const std::lock_guard lock{mutex_};
    if (note(message, sample, rest_)) {
      ++entry_of(rest_.others, sample->spacecraft).second;
    }
  }

  /// What belongs to no batch of samples. @param now See RejectionLimit.
  SampleBatch take_rest(TaiTime now);

  std::map<std::string, SequenceCounts> by_source() const;
  /// Of ours.
  CountsBySpacecraft by_spacecraft() const;

 private:
  /// @return whether it can be true.
  template <class Value>
  bool note(const bus::MessageOf<Value>& message, const Expected<TelemetrySample<Value>>& sample,
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

  mutable std::mutex mutex_;  // Guards the four below.
  SequenceTracker tracker_;
  RejectionLimit limit_;
  SampleBatch rest_;
  CountsBySpacecraft by_spacecraft_;
};

}  // namespace spindrift
