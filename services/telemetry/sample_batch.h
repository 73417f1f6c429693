/// @file
/// Input handed from the receiving to the processing thread.

#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "services/telemetry/by_kind.h"
#include "services/telemetry/operator_action.h"
#include "services/telemetry/rejected_input.h"
#include "services/telemetry/sequence_counts.h"

namespace spindrift {

/// Counts of samples of spacecraft that have no mission here, by name.
using OtherSpacecraft = std::map<std::string, std::int64_t>;

inline constexpr std::size_t kMostOtherSpacecraft = 256;
inline constexpr const char* kStillMoreSpacecraft = "(others)";

/// Returns the count for `spacecraft`. Those beyond kMostOtherSpacecraft share the entry
/// kStillMoreSpacecraft.
inline OtherSpacecraft::value_type& entry_of(OtherSpacecraft& others,
                                             const std::string& spacecraft) {
  const bool room = others.size() < kMostOtherSpacecraft || others.contains(spacecraft);
  return *others.try_emplace(room ? spacecraft : kStillMoreSpacecraft).first;
}

/// Holds samples in order of arrival. All batches together hold everything that arrived.
struct SampleBatch {
  TelemetrySamples samples = {};
  std::vector<OperatorAction> actions = {};  ///< In order, behind the samples.
  std::vector<RejectedInput> rejected = {};
  /// Counts samples that the bus does not hand over. Those of a file stand among `samples`.
  OtherSpacecraft others = {};
  /// Counts by source, from the start to the end of this batch. Empty for a file.
  std::map<std::string, SequenceCounts> counts = {};
  /// When a batch from the bus was queued.
  std::optional<std::chrono::steady_clock::time_point> came = {};
};

/// Counts samples, actions and rejected input.
inline std::size_t size_of(const SampleBatch& batch) {
  return count_of(batch.samples) + batch.actions.size() + batch.rejected.size();
}

/// Returns whether the batch has neither items nor counts.
inline bool is_empty(const SampleBatch& batch) {
  return size_of(batch) == 0 && batch.others.empty() && batch.counts.empty();
}

}  // namespace spindrift
