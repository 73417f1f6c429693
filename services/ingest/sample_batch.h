/// @file
/// What goes from the thread that takes samples to the one that works on them.

#pragma once

#include <map>
#include <string>
#include <vector>

#include "services/ingest/rejected_input.h"
#include "services/ingest/sample.h"
#include "services/ingest/sequence_counts.h"

namespace spindrift {

/// Samples of one kind in order of arrival; all batches together are everything that arrived.
struct SampleBatch {
  std::vector<PulseSample> pulses = {};
  std::vector<CodedSample> coded = {};
  std::vector<RejectedInput> rejected = {};
  /// Of the sources in it, from the start up to and including this batch. Empty for a file.
  std::map<std::string, SequenceCounts> counts = {};
};

}  // namespace spindrift
