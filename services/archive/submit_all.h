/// @file
/// From the processor to the archive.

#pragma once

#include <utility>
#include <vector>

#include "services/archive/archive.h"

namespace spindrift {

/// Stops at the first batch that is refused. @return as Archive::submit.
inline Expected<void> submit_all(Archive& archive, std::vector<ArchiveBatch> batches) {
  for (ArchiveBatch& batch : batches) {
    if (auto taken = archive.submit(std::move(batch)); !taken) {
      return taken;
    }
  }
  return {};
}

}  // namespace spindrift
