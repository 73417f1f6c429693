/// @file
/// The machine: its clock, and the limits it sets.

#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "services/doctor/check.h"

namespace spindrift::doctor {

struct HostFacts {
  int year;                                  ///< UTC, by the system clock.
  std::optional<bool> clock_synchronised;    ///< Absent: the kernel does not tell.
  double clock_error_s = 0.0;                ///< At most, by the kernel; when synchronised.
  std::uint64_t open_files = 0;              ///< How many this process may have.
  std::optional<std::int64_t> memory_bytes;  ///< Available; absent: the kernel does not tell.
  int sqlite_version = 0;                    ///< As SQLite numbers it: 3040001 is 3.40.1.
};

HostFacts host_facts();

std::vector<Check> check_host(const HostFacts& facts);

}  // namespace spindrift::doctor
