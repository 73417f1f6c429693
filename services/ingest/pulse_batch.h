/// @file
/// What goes from the thread that takes pulses to the one that works on them.

#pragma once

#include <vector>

#include "services/ingest/rejected_input.h"
#include "services/ingest/sample.h"

namespace spindrift {

/// In order of arrival; both together are everything that arrived.
struct PulseBatch {
  std::vector<PulseSample> pulses;
  std::vector<RejectedInput> rejected;
};

}  // namespace spindrift
