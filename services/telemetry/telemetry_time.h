/// @file
/// Range of valid telemetry times, the same for files and the bus.

#pragma once

#include "pipelines/time/tai_time.h"

namespace spindrift {

/// 1972-01-01T00:00:00 UTC, when UTC was defined (TAI - UTC was 10 s).
inline constexpr TaiTime kEarliestTelemetry = tai_from_ns(63'072'010'000'000'000);
/// 2100-01-01T00:00:00 TAI, the first time that is too late.
inline constexpr TaiTime kLatestTelemetry = tai_from_ns(4'102'444'800'000'000'000);

constexpr bool is_telemetry_time(TaiTime t) {
  return t >= kEarliestTelemetry && t < kLatestTelemetry;
}

}  // namespace spindrift
