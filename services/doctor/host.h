/// @file
/// Checks the clock and the limits of the machine, and the leap seconds it knows.

#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "services/base/leap_tables.h"
#include "services/doctor/check.h"

namespace spindrift::doctor {

struct HostFacts {
  int year;                                  ///< Year in UTC of the system clock.
  std::optional<bool> clock_synchronised;    ///< Empty when the kernel does not tell.
  double clock_error_s = 0.0;                ///< Upper limit by the kernel, if synchronised.
  std::uint64_t open_files = 0;              ///< Limit for this process.
  std::optional<std::int64_t> memory_bytes;  ///< Available; empty when the kernel does not tell.
  int sqlite_version = 0;                    ///< SQLite's number: 3040001 is 3.40.1.
};

HostFacts host_facts();

std::vector<Check> check_host(const HostFacts& facts);

/// Checks whether the program's leap second table is complete.
Check check_leap_seconds(const LeapFacts& facts);

}  // namespace spindrift::doctor
