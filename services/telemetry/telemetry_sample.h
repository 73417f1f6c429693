/// @file
/// A telemetry sample with its origin, the same for bus and files.

#pragma once

#include <cstdint>
#include <string>

#include "services/telemetry/places.h"

namespace spindrift {

/// Identifies a sample. On the bus: source, session and seq of the IDL. In a file: its unique name,
/// 0 and the line.
struct Origin {
  std::string source;
  std::uint64_t session = 0;
  std::uint64_t seq = 0;
};

/// A sample as it is taken in. `Value` is a kind in telemetry_kinds.h.
template <class Value>
struct TelemetrySample {
  std::string spacecraft;
  Origin origin;
  Value value;
  BatchPlace place = {};
};

/// A sample that a run has taken.
template <class Value>
struct ArrivedSample {
  std::string spacecraft;
  Origin origin;
  Value value;
  RunPlace arrival = {};
  bool is_left_out = false;  ///< The time of its source disagrees with that of the others.
};

}  // namespace spindrift
