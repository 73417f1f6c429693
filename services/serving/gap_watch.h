/// @file
/// Which gaps last. Samples that are merely on their way leave gaps too, for a moment.

#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "services/telemetry/sequence_counts.h"

namespace spindrift {

class GapWatch {
 public:
  /// To be called at a steady beat.
  /// @return the sources that missed samples at the beat before as well, and how many at least.
  std::map<std::string, std::uint64_t> beat(const std::map<std::string, SequenceCounts>& by_source);

 private:
  std::map<std::string, std::uint64_t> before_;
};

/// "front-end 3, replay 1"
std::string to_text(const std::map<std::string, std::uint64_t>& gaps);

}  // namespace spindrift
