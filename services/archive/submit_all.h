/// @file
/// Passes batches from the processor to the archive.

#pragma once

#include <utility>
#include <vector>

#include "services/archive/archive.h"

namespace spindrift {

/// Submits the batches in order and stops at the first that is refused.
/// @return Errors as Archive::submit.
inline Expected<void> submit_all(Archive& archive, std::vector<ArchiveBatch> batches) {
  for (ArchiveBatch& batch : batches) {
    if (auto taken = archive.submit(std::move(batch)); !taken) {
      return taken;
    }
  }
  return {};
}

}  // namespace spindrift
