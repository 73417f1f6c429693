/// @file
/// Finds gaps that last: samples that are merely under way leave gaps for a moment, too.

#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "services/telemetry/sequence_counts.h"

namespace spindrift {

class GapWatch {
 public:
  /// Compares the gaps with those of the previous call. To be called at a steady rate.
  /// @return Sources that missed samples at the previous call too, with the number still missing.
  std::map<std::string, std::uint64_t> beat(const std::map<std::string, SequenceCounts>& by_source);

 private:
  std::map<std::string, std::uint64_t> before_;
};

/// Returns text such as "front-end 3, replay 1".
std::string to_text(const std::map<std::string, std::uint64_t>& gaps);

}  // namespace spindrift
