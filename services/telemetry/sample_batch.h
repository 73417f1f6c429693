/// @file
/// What goes from the thread that takes samples to the one that works on them.

#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "services/telemetry/by_kind.h"
#include "services/telemetry/operator_action.h"
#include "services/telemetry/other_spacecraft.h"
#include "services/telemetry/rejected_input.h"
#include "services/telemetry/sequence_counts.h"

namespace spindrift {

/// Samples in order of arrival; all batches together are everything that arrived.
struct SampleBatch {
  TelemetrySamples samples = {};
  std::vector<OperatorAction> actions = {};  ///< Behind the samples, in order.
  std::vector<RejectedInput> rejected = {};
  /// From the bus, which does not hand these samples over. Of a file they stand among `samples`.
  OtherSpacecraft others = {};
  /// Of the sources in it, from the start up to and including this batch. Empty for a file.
  std::map<std::string, SequenceCounts> counts = {};
  /// From the bus: when it was queued.
  std::optional<std::chrono::steady_clock::time_point> came = {};
};

/// Samples, actions and rejected input.
inline std::size_t size_of(const SampleBatch& batch) {
  return count_of(batch.samples) + batch.actions.size() + batch.rejected.size();
}

/// Whether nothing at all came, not even to be counted.
inline bool is_empty(const SampleBatch& batch) {
  return size_of(batch) == 0 && batch.others.empty() && batch.counts.empty();
}

}  // namespace spindrift
