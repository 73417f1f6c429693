/// @file
/// A slow solution: a closure that a run hands out, and that whoever has the time calls.

#pragma once

#include <functional>
#include <vector>

#include "pipelines/core/expected.h"
#include "services/archive/records.h"
#include "services/processor/run_summary.h"

namespace spindrift {

/// Those of a run are solved and stored in the order in which it handed them out.
struct BackgroundTask {
  ArchiveBatch batch;  ///< For the archive, with what `solve` gives, if anything.
  /// On any thread, while the run that handed it out is there.
  std::function<Expected<std::vector<Product>>()> solve;
  RunSummary* summary = nullptr;  ///< Of the run that has ended with it: it is counted there.
};

}  // namespace spindrift
