/// @file
/// How the samples of a source came in.

#pragma once

#include <cstdint>

namespace spindrift {

struct SequenceCounts {
  std::uint64_t received = 0;  ///< All that arrived, duplicates too.
  std::uint64_t missing = 0;   ///< Gaps: between the lowest and highest seq of a session, not here.
  std::uint64_t duplicates = 0;  ///< Arrived before, same session and seq.
  std::uint64_t disordered = 0;  ///< Arrived after a higher seq of its session and spacecraft.

  SequenceCounts& operator+=(const SequenceCounts& other) {
    received += other.received;
    missing += other.missing;
    duplicates += other.duplicates;
    disordered += other.disordered;
    return *this;
  }
  friend bool operator==(const SequenceCounts&, const SequenceCounts&) = default;
};

}  // namespace spindrift
