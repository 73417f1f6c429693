/// @file
/// Converts UTC text to TAI and back, with the leap seconds of ERFA.
///
/// UTC is supported from 1972-01-01, when its offset from TAI became a whole number of seconds.

#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "pipelines/core/expected.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

/// Parses CCSDS/ISO 8601 text, as calendar date (2026-11-20T03:00:00.000) or day of year
/// (2026-324T03:00:00), with any number of decimals (rounded to 1 ns) and an optional final Z.
/// 23:59:60 is accepted where a leap second was.
/// @return InvalidInput with the text and the fault; also before 1972 and after 2189, because
///         64-bit nanoseconds do not hold differences of several centuries.
Expected<TaiTime> parse_utc(std::string_view text);

/// Parses the same text formats as TAI (no leap seconds), from 1900 on.
Expected<TaiTime> parse_tai(std::string_view text);

/// Formats as ISO 8601 with `decimals` (0 to 9) truncated decimals and a final Z; 23:59:60 within a
/// leap second. Before 1972 there is no UTC: the text is TAI and ends in " TAI".
std::string format_utc(TaiTime t, int decimals = 3);

/// Holds one offset: from `start` on, TAI - UTC = `tai_minus_utc_s`.
struct LeapSecond {
  TaiTime start;
  int tai_minus_utc_s = 0;
};

/// Returns all whole-second offsets since 1972, in time order.
std::vector<LeapSecond> leap_seconds();

}  // namespace spindrift
