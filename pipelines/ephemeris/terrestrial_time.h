/// @file
/// Terrestrial Time as ERFA takes it: a Julian date in two parts, which together hold more digits
/// than one double.

#pragma once

#include <erfam.h>

#include "pipelines/time/tai_time.h"

namespace spindrift {

/// First part: the Julian date of 1970-01-01.
inline constexpr double kTaiEpoch_jd = 2440587.5;

/// Returns the second part: days since then.
constexpr double tt_days(TaiTime t) {
  return (seconds_between(TaiTime{}, t) + ERFA_TTMTAI) / ERFA_DAYSEC;
}

}  // namespace spindrift
