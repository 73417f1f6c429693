/// @file
/// A telemetry sample with where it came from, the same from the bus and from a file.

#pragma once

#include <cstdint>
#include <string>

namespace spindrift {

/// Which sample of which sender. On the bus: source, session and seq of the IDL. From a file: its
/// name, told apart from others of that name, 0 and the line.
struct Origin {
  std::string source;
  std::uint64_t session = 0;
  std::uint64_t seq = 0;
};

/// `Value`: a kind of telemetry_kinds.h.
template <class Value>
struct TelemetrySample {
  std::string spacecraft;
  Origin origin;
  Value value;
  std::int64_t arrival = 0;  ///< Among the samples of its batch, later of its run; larger: later.
};

}  // namespace spindrift
