/// @file
/// What goes from the thread that takes pulses to the one that works on them.

#pragma once

#include <map>
#include <string>
#include <vector>

#include "services/ingest/rejected_input.h"
#include "services/ingest/sample.h"
#include "services/ingest/sequence_counts.h"

namespace spindrift {

/// In order of arrival; both together are everything that arrived.
struct PulseBatch {
  std::vector<PulseSample> pulses;
  std::vector<RejectedInput> rejected;
  /// Of the sources in it, from the start up to and including this batch. Empty for a file.
  std::map<std::string, SequenceCounts> counts = {};
};

}  // namespace spindrift
