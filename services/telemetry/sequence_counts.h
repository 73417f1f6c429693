/// @file
/// Counts of received, missing and repeated samples of a source.

#pragma once

#include <cstdint>

namespace spindrift {

struct SequenceCounts {
  std::uint64_t received = 0;    ///< All samples that arrived, duplicates included.
  std::uint64_t missing = 0;     ///< Gaps between the lowest and highest seq of a session.
  std::uint64_t duplicates = 0;  ///< Samples whose session and seq had arrived before.
  std::uint64_t disordered = 0;  ///< Samples after a higher seq of their session and spacecraft.

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
