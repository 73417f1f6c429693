/// @file
/// The tables of leap seconds that this program and this machine know.

#pragma once

#include <chrono>
#include <optional>
#include <string_view>

#include "pipelines/time/tai_time.h"

namespace spindrift {

/// A table of leap seconds: its last offset and the day until which it is known to be complete.
struct LeapTable {
  int tai_minus_utc_s;
  std::chrono::sys_days complete_until;
};

struct LeapFacts {
  std::chrono::sys_days day;         ///< For which they are to be known.
  LeapTable erfa;                    ///< With which the program computes.
  std::optional<LeapTable> machine;  ///< Of the package tzdata; absent where it is not installed.
};

/// From the text of leap-seconds.list, whose times are seconds since 1900. Absent for another text.
std::optional<LeapTable> machine_table(std::string_view text);

/// @param t For which they are to be known.
LeapFacts leap_facts(TaiTime t);

}  // namespace spindrift
