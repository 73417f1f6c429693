/// @file
/// A slow solution: a closure that a run hands out, and that whoever has the time calls.

#pragma once

#include <functional>
#include <string>

#include "pipelines/core/expected.h"
#include "services/archive/records.h"

namespace spindrift {

struct BackgroundTask {
  std::string spacecraft_id;
  /// On any thread, while the run that handed it out is there. What it gives is for the archive.
  std::function<Expected<ArchiveBatch>()> solve;
};

}  // namespace spindrift
