/// @file
/// The leap second tables of this program and of this machine.

#pragma once

#include <chrono>
#include <optional>
#include <string_view>

#include "pipelines/time/tai_time.h"

namespace spindrift {

/// A table of leap seconds: its last offset and the day until which it is known to be complete.
struct LeapTable {
  int tai_minus_utc_s;
  std::chrono::sys_days since;  ///< Day from which the offset holds.
  std::chrono::sys_days complete_until;
};

struct LeapFacts {
  std::chrono::sys_days day;         ///< Day for which both must hold.
  LeapTable erfa;                    ///< Table that the program uses.
  std::optional<LeapTable> machine;  ///< Table of package tzdata, if installed.
};

/// Parses leap-seconds.list, whose times are seconds since 1900. Returns empty for any other text.
std::optional<LeapTable> machine_table(std::string_view text);

/// Returns the day from which UTC is wrong, as the machine's table has a leap second that the
/// program's lacks.
std::optional<std::chrono::sys_days> lacking_from(const LeapFacts& facts);

/// @param t Time for which the leap seconds must be known.
LeapFacts leap_facts(TaiTime t);

}  // namespace spindrift
