/// @file
/// A telemetry sample with its origin, the same for bus and files.

#pragma once

#include <cstdint>
#include <string>

namespace spindrift {

/// Identifies a sample. On the bus: source, session and seq of the IDL. In a file: its unique name,
/// 0 and the line.
struct Origin {
  std::string source;
  std::uint64_t session = 0;
  std::uint64_t seq = 0;
};

/// `Value` is a kind in telemetry_kinds.h.
template <class Value>
struct TelemetrySample {
  std::string spacecraft;
  Origin origin;
  Value value;
  std::int64_t arrival = 0;  ///< Rises in the order of its batch, later of its run.
};

}  // namespace spindrift
