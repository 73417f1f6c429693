/// @file
/// Instants. All times in spindrift are TAI in integer nanoseconds; UTC occurs only as text.

#pragma once

#include <chrono>
#include <cstdint>

namespace spindrift {

/// Measures International Atomic Time since 1970-01-01T00:00:00 TAI.
///
/// It has no `now()`, so that pipelines can compare instants but not read the wall clock.
/// (libstdc++ 12 lacks `std::chrono::tai_clock`, whose epoch is 1958.)
struct TaiClock {
  using duration = std::chrono::nanoseconds;
  using rep = duration::rep;
  using period = duration::period;
  using time_point = std::chrono::time_point<TaiClock>;
  static constexpr bool is_steady = false;
};
using TaiTime = TaiClock::time_point;

inline constexpr double kHour_s = 3600.0;

constexpr TaiTime tai_from_ns(std::int64_t t_tai_ns) {
  return TaiTime{std::chrono::nanoseconds{t_tai_ns}};
}
constexpr std::int64_t tai_ns(TaiTime t) { return t.time_since_epoch().count(); }

/// Returns `later - earlier` in seconds. The integers are subtracted first, because a double cannot
/// hold nanoseconds since the epoch, only those of a pass.
constexpr double seconds_between(TaiTime earlier, TaiTime later) {
  return static_cast<double>((later - earlier).count()) * 1e-9;
}

/// Returns `t` moved by `offset_s` seconds, to the nearest nanosecond.
constexpr TaiTime shifted(TaiTime t, double offset_s) {
  const double offset_ns = offset_s * 1e9;
  return t + std::chrono::nanoseconds{
                 static_cast<std::int64_t>(offset_ns < 0.0 ? offset_ns - 0.5 : offset_ns + 0.5)};
}

}  // namespace spindrift
