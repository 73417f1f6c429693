/// @file
/// UTC text to TAI and back, with the leap seconds of ERFA.
///
/// UTC exists here from 1972-01-01, when its offset from TAI became a whole number of seconds.

#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "pipelines/core/expected.h"
#include "pipelines/time/tai_time.h"

namespace spindrift {

/// Reads CCSDS/ISO 8601 text, calendar (2026-11-20T03:00:00.000) or day of year
/// (2026-324T03:00:00), any number of decimals (rounded to 1 ns), with or without a final Z.
/// 23:59:60 is read where a leap second was.
/// @return InvalidInput with the text and what is wrong with it; likewise before 1972 and after
///         2189: 64-bit nanoseconds do not hold the difference of instants centuries apart.
Expected<TaiTime> parse_utc(std::string_view text);

/// The same text read as TAI (no leap seconds), from 1900 on.
Expected<TaiTime> parse_tai(std::string_view text);

/// ISO 8601 with `decimals` (0 to 9) decimals, truncated, and a final Z; 23:59:60 within a leap
/// second. Before 1972 the text is TAI and ends in " TAI": no UTC can be given.
std::string format_utc(TaiTime t, int decimals = 3);

/// From `start` on, TAI - UTC = `tai_minus_utc_s`.
struct LeapSecond {
  TaiTime start;
  int tai_minus_utc_s = 0;
};

/// All whole-second offsets since 1972, in order of time.
std::vector<LeapSecond> leap_seconds();

}  // namespace spindrift
