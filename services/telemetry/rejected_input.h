/// @file
/// Telemetry that could not be read or is impossible, with the reason.

#pragma once

#include <cstdint>
#include <string>

namespace spindrift {

/// Kept and counted in place of the sample.
struct RejectedInput {
  std::string source;         ///< Path of the file as it was given, or source on the bus.
  std::int64_t line;          ///< Line of the file, from 1; on the bus the sample's seq.
  std::string reason;         ///< Names the field, its value and what is allowed.
  std::uint64_t session = 0;  ///< Session on the bus; 0 for a file.
  std::int64_t samples = 1;   ///< Number of rejected samples it stands for, itself the last.
};

}  // namespace spindrift
