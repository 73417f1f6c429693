/// @file
/// Telemetry that could not be read or cannot be true, with its reason.

#pragma once

#include <cstdint>
#include <string>

namespace spindrift {

/// Kept and counted instead of the sample that it is not.
struct RejectedInput {
  std::string source;         ///< Path of the file as it was given, or source on the bus.
  std::int64_t line;          ///< Line of the file, from 1; on the bus the sample's seq.
  std::string reason;         ///< Field, value and what is allowed.
  std::uint64_t session = 0;  ///< Of the source on the bus, which `line` counts in; 0 for a file.
  std::int64_t samples = 1;   ///< More than one: it stands for so many, of which it is the last.
};

}  // namespace spindrift
